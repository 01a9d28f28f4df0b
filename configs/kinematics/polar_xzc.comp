component polar_xzc "switchable kinematics of a lathe with an X slide and a C axis";

description
"""
Kinematics module for a lathe whose tool is on the X slide and whose work spindle turns as the C
axis. It has two types:

.B Type 0
is X, Z and C as they are: each axis is its joint. LinuxCNC starts in it.

.B Type 1
is the face of the part: X and Y are the tool's position on the face, in the part's frame, Z is Z. The
slide is at hypot(X, Y) and C at the angle of (X, Y), so lines and arcs in X and Y are lines and arcs
on the part, planned by LinuxCNC with its whole look-ahead. C's zero line is the angle of C at the
switch to this type: there the tool is at X, Y0. C continues over full turns, and the slide never
moves below the centre.

A tool that does not pass the spindle's axis is beside the X axis of the machine, by
\\fBpolar-xzc.tool-offset\\fR, above zero on the side to which C turns the part's X axis. Then the face
begins at X, Y \\fBtool-offset\\fR, and the tool comes no nearer to the centre than that.

Load it in place of trivkins:

.RS
.nf
[KINS]
JOINTS = 3
KINEMATICS = polar_xzc coordinates=XZC
[TRAJ]
COORDINATES = X Y Z C
.fi
.RE

\\fBcoordinates\\fR gives each joint its letter, as with trivkins: X and C have to be there, Y may
not be (it has no joint), each letter once. Letters other than X and C are their joints in both
types.

The pin \\fBmotion.switchkins-type\\fR selects the type. The function \\fBpolar-xzc.guard\\fR, in the
servo thread after motion-controller, drives it:

.RS
.nf
addf polar-xzc.guard servo-thread
net polar-centre motion.analog-out-02 => polar-xzc.centre
net polar-request motion.analog-out-03 => polar-xzc.request
net polar-enabled motion.motion-enabled => polar-xzc.enabled
net polar-program motion.coord-mode => polar-xzc.program
net polar-in-position motion.in-position => polar-xzc.stands
net polar-type polar-xzc.type => motion.switchkins-type
net polar-face polar-xzc.face => motion.digital-in-03
net polar-jog polar-xzc.jog-inhibit => motion.jog-inhibit
net polar-speed motion.requested-vel => polar-xzc.speed
net polar-feed-upm motion.feed-upm => polar-xzc.feed-upm
net polar-feed polar-xzc.feed => motion.adaptive-feed
.fi
.RE

so that M68 E3 Q1 requests the face and M68 E3 Q0 X, Z and C. \\fBcentre\\fR is the position of the X
joint at which the tool is on the spindle's axis; it is read at the switch to the face, as is
\\fBtool-offset\\fR.
The guard switches only when the machine has been at rest for six cycles. It switches back to type 0 by
itself when the machine is switched off, stopped in an emergency or jogged, and when
\\fBend-request\\fR is set; then the request has to be withdrawn before a new one counts. While the
face is on and no program or MDI moves the machine, jogs are inhibited.

On the face, with M52 P1, the operator's feed override applies up to \\fBmost-override\\fR, if that is
not 0: \\fBfeed\\fR reduces a higher one. G12.1 sets the pin, and \\fBunit\\fR, a program's unit in the
machine's, from which the module calculates the override.

.B Refusals.
A move that has no meaning in the active type fails with a message: one to a Y other than 0 in type 0,
and one of C in type 1. So does any move while the active type is not the requested one. The face is
not switched on with the tool beyond the centre.

.B The centre.
In the centre the angle of C is free. It does not change there, so a path that leaves the centre in
another direction than that of its approach needs a turn of C in type 0 in between. LinuxCNC knows
nothing of C's speed while it plans X and Y: feeds near the centre have to be chosen so that C can
follow. The G12.1 of this package does both.

.B LinuxCNC's own G12.1.
Versions after 2.9 have G12.1 P1 and G13.1, which select the type without the guard's care. The
module tells them that type 0 is X, Z and C.
""";

modparam dummy coordinates=XZC "letter of each joint";

pin in float request "1 requests the face, any other value X, Z and C";
pin in float centre "position of the X joint with the tool on the spindle's axis";
pin in float tool_offset "of the tool from the X line: [G12]POLAR_TOOL_OFFSET";
pin in bit enabled "the machine is on: motion.motion-enabled";
pin in bit program "a program or MDI moves the machine, not a jog: motion.coord-mode";
pin in bit stands "the machine is at rest: motion.in-position";
pin in float speed "commanded speed: motion.requested-vel";
pin in float feed_upm "present feed, program units a minute: motion.feed-upm";
pin in float unit = 1.0 "of the program, in the machine's";
pin in float most_override "of the feed on the face by program, 0 for any";
pin io bit end_request "true ends the request, as an abort has to; the guard resets it";
pin out float type "for motion.switchkins-type";
pin out bit face "type 1 is active";
pin out bit jog_inhibit "type 1 is active without a program or MDI: for motion.jog-inhibit";
pin out float feed = 1.0 "what remains of the speed: for motion.adaptive-feed";

function guard "Choose the type.";

option singleton yes;
option period no;
option extra_setup yes;
license "GPL";
author "the g12 package";
;;

#include <rtapi_math.h>
#include <rtapi_string.h>
#include <hal.h>
#include <emcmotcfg.h>
#include <kinematics.h>

/* ---- The kinematics: where joints and axes are, in the type that is active. ---- */

#define DEGREE (M_PI / 180.0)
#define AT_CENTRE 1e-6 /* machine units: within this distance the angle of C is free */
#define NO_MOVE 1e-6   /* machine units or degrees: rounding of an absent word */

enum { XZC, FACE };
static const char letters[] = "XYZABCUVW";

static char *coordinates = "XZC";
RTAPI_MP_STRING(coordinates, "letter of each joint");

static struct {
    int active;           /* XZC or FACE */
    int face_has_no_zero; /* the face was switched on, and the joints' positions are not known yet */
    int takes_lines;      /* motion calls for a line of a program or MDI, not for a cycle: between the
                             guard, at a cycle's end, and kinematicsForward */
    int request_ended;    /* the request for the face ended by itself, and was not withdrawn since */
    double origin;        /* of the face: position of the X joint */
    double zero;          /* of the face: C in degrees on its X axis */
    double beside;        /* distance of the tool from the X line */
    int joints;
    int axis[EMCMOT_MAX_JOINTS]; /* index of each joint's letter */
    int x, c;                    /* joints */
} state;
static struct __comp_state *component;

static double *axis_of(EmcPose *pose, int axis)
{
    double *axes[] = {&pose->tran.x, &pose->tran.y, &pose->tran.z, &pose->a, &pose->b,
                      &pose->c, &pose->u, &pose->v, &pose->w};
    return axes[axis];
}

/* Take the joints' letters; return 0, or -1 for a machine that has no face. */
static int take_coordinates(const char *text)
{
    int times[EMCMOT_MAX_AXIS] = {0};
    const char *found;

    state.joints = 0;
    for (; *text; text++) {
        found = strchr(letters, *text & ~0x20);
        if (!found || !*found || times[found - letters]++ || *found == 'Y') return -1;
        if (state.joints == EMCMOT_MAX_JOINTS) return -1;
        if (*found == 'X') state.x = state.joints;
        if (*found == 'C') state.c = state.joints;
        state.axis[state.joints++] = found - letters;
    }
    return times[0] && times[5] ? 0 : -1;
}

/* Put the face's X axis at the angle of C; remain in X, Z and C with the tool beyond the centre. */
static void begin_face(const double *joint)
{
    state.face_has_no_zero = 0;
    if (joint[state.x] < state.origin) state.active = XZC;
    state.zero = joint[state.c];
}

int kinematicsForward(const double *joint, EmcPose *pose,
                      const KINEMATICS_FORWARD_FLAGS *fflags, KINEMATICS_INVERSE_FLAGS *iflags)
{
    double slide, angle;
    int k;

    (void)fflags;
    (void)iflags;
    state.takes_lines = 0;
    if (state.face_has_no_zero) begin_face(joint);
    memset(pose, 0, sizeof(*pose));
    for (k = 0; k < state.joints; k++) *axis_of(pose, state.axis[k]) = joint[k];
    if (state.active == FACE) {
        slide = joint[state.x] - state.origin;
        angle = (joint[state.c] - state.zero) * DEGREE;
        pose->tran.x = state.origin + slide * cos(angle) - state.beside * sin(angle);
        pose->tran.y = slide * sin(angle) + state.beside * cos(angle);
        pose->c = state.zero;
    }
    return 0;
}

/* Return whether the face is requested, by a request that did not end by itself. */
static int is_face_requested(const struct __comp_state *__comp_inst)
{
    return request == FACE && !state.request_ended;
}

/* Return whether a line of a program or MDI comes while the requested type is not active yet. The
   present move is completed. */
static int comes_too_early(const struct __comp_state *__comp_inst)
{
    return state.takes_lines && program && is_face_requested(__comp_inst) != (state.active == FACE);
}

/* Report to the operator why there are no joints: LinuxCNC shows a module's errors as its own. */
static int refuse(const char *reason)
{
    rtapi_print_msg(RTAPI_MSG_ERR, "polar mode: %s\n", reason);
    return -1;
}

/* joint has the present positions: C continues from there over the full turns. */
int kinematicsInverse(const EmcPose *pose, double *joint,
                      const KINEMATICS_INVERSE_FLAGS *iflags, KINEMATICS_FORWARD_FLAGS *fflags)
{
    EmcPose world = *pose;
    double x, y, slide, square, present = joint[state.c];
    int k;

    (void)iflags;
    (void)fflags;
    if (comes_too_early(component))
        return refuse("the machine is about to change its kinematics, nothing moves until then");
    if (state.active == XZC && fabs(world.tran.y) > NO_MOVE)
        return refuse("Y moves only on the face, from G12.1 to G13.1");
    if (state.active == FACE && fabs(world.c - state.zero) > NO_MOVE)
        return refuse("C does not move by itself on the face: write X and Y, or G13.1 first");
    for (k = 0; k < state.joints; k++) joint[k] = *axis_of(&world, state.axis[k]);
    if (state.active == FACE) {
        x = world.tran.x - state.origin;
        y = world.tran.y;
        square = x * x + y * y - state.beside * state.beside; /* of the slide's position */
        if (square < -AT_CENTRE * fabs(state.beside))
            return refuse("the tool is beside X's line and comes no nearer to the centre");
        slide = sqrt(fmax(square, 0.0));
        joint[state.x] = state.origin + slide;
        joint[state.c] = present;
        if (slide > AT_CENTRE || state.beside != 0.0) {
            joint[state.c] = state.zero + (atan2(y, x) - atan2(state.beside, slide)) / DEGREE;
            joint[state.c] += 360.0 * floor((present - joint[state.c]) / 360.0 + 0.5);
        }
    }
    return 0;
}

KINEMATICS_TYPE kinematicsType(void) { return KINEMATICS_BOTH; }

int kinematicsSwitchable(void) { return 1; }

int kinematicsSwitch(int kind)
{
    struct __comp_state *__comp_inst = component;

    if (kind != XZC && kind != FACE) return -1;
    state.active = kind;
    state.face_has_no_zero = kind == FACE;
    state.origin = centre;
    state.beside = tool_offset;
    return 0;
}

/* LinuxCNC after 2.9 reads the properties of a type; -1 is none. Its G13.1 selects type 0. */
int kinematicsTypeFlags(int kind)
{
#ifdef KINSTYPE_IDENTITY
    if (kind == XZC) return KINSTYPE_IDENTITY;
    if (kind == FACE) return KINSTYPE_PRIMARY;
#endif
    (void)kind;
    return -1;
}

EXPORT_SYMBOL(kinematicsForward);
EXPORT_SYMBOL(kinematicsInverse);
EXPORT_SYMBOL(kinematicsType);
EXPORT_SYMBOL(kinematicsSwitchable);
EXPORT_SYMBOL(kinematicsSwitch);
EXPORT_SYMBOL(kinematicsTypeFlags);

/* ---- The guard, in each servo cycle: the type that is requested, and the feed on the face. ---- */

#define SETTLED 6 /* cycles at rest: LinuxCNC smooths the joints' motion over the last four */
#define LEAST_FEED 0.01 /* no override is so high that it needs less */

/* Choose the type. A switch during a jog would make the axes jump to their positions before it. */
static void choose_type(struct __comp_state *__comp_inst)
{
    static int at_rest; /* cycles */

    state.request_ended =
        request == FACE && (state.request_ended || end_request || !enabled || !program);
    end_request = 0;
    at_rest = stands ? at_rest + (at_rest < SETTLED) : 0;
    if (!enabled || (program && at_rest == SETTLED))
        type = is_face_requested(__comp_inst) ? FACE : XZC;
    face = state.active == FACE && !state.face_has_no_zero;
    jog_inhibit = face && !program;
}

/* Return the operator's feed override during the last motion: the feed that LinuxCNC reports is F
   times the override times `feed` of the cycle before. */
static double feed_override(const struct __comp_state *__comp_inst)
{
    static double last = 1.0;

    if (feed_upm > 0.0 && speed > 0.0) last = feed_upm * unit / (60.0 * speed * feed);
    return last;
}

/* Return the share of the commanded speed that is left of an override beyond the highest. */
static double share_of_speed(const struct __comp_state *__comp_inst)
{
    double overridden = feed_override(__comp_inst);

    if (!face || most_override <= 0.0 || overridden <= most_override) return 1.0;
    return fmax(most_override / overridden, LEAST_FEED);
}

FUNCTION(guard)
{
    choose_type(__comp_inst);
    feed = share_of_speed(__comp_inst);
    state.takes_lines = 1;
}

EXTRA_SETUP()
{
    (void)prefix;
    (void)extra_arg;
    component = __comp_inst;
    if (take_coordinates(coordinates)) {
        rtapi_print_msg(RTAPI_MSG_ERR, "polar_xzc: coordinates=%s: X and C have to be there, Y"
                        " may not, each letter once\n", coordinates);
        return -1;
    }
    return 0;
}
