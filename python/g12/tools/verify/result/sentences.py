# SPDX-License-Identifier: GPL-2.0-or-later
"""Every sentence of verify, by its code. A finding is a fault; a note is what a user should know.

Braces name a value of the finding; what follows the colon says how ``finding`` formats it.
"""

FINDINGS = {
    # the toolpath, of every kind of cut
    "path-off": "the {what} is {size:fine} off the toolpath that the words ask for, at {at:xyz}",
    "path-missing": "the {what} is not cut: it should end at {at:xyz}",
    "path-extra": "a move to {at:xyz} that the words do not ask for",
    "rapid": "the {what} goes by rapid, not at a feed, to {at:xyz}",
    "not-rapid": "the {what} goes at a feed, not by rapid, to {at:xyz}",
    "feed": "the {what} is cut at {made:feed}, not at {expected:feed}",
    "feed-rev": "the {what} is cut at {made:fine} per revolution, not at {expected:fine}",
    "feed-mode": "the {what} has its feed {made}, not {expected}",
    "not-cut": "nothing is cut",
    "not-measured": "a cycle cuts here that could not be measured",
    "state": "it leaves {found}, not {expected}",
    "extra-event": "{event} comes in it, where the words do not have it",
    # pockets
    "uncut": "{area:mm2} of material remain uncut",
    "wall-run": "the wall was cut {size:fine} too far, at {at:xyz}",
    "wrong-cutter": (
        "the loaded tool T{tool} (⌀ {loaded:mm}) is not D{named} (⌀ {diameter:mm}): "
        "the wall comes out at radius {cut:mm}, not {wall:mm}"
    ),
    "cuts-air": (
        "its depth Z{depth:mm} lies above Z{start:mm}, where the tool comes from: it cuts air{hint}"
    ),
    "travel": "the {axis} axis would go to {position:mm}, its limit is {limit:length}",
    # the tool
    "length-deeper": (
        "the tool length in force, {offset:mm}, is not that of T{tool}: "
        "it cuts {off:fine} deeper than its words say (G43 H{tool} after M6?)"
    ),
    "offset-beside": (
        "the tool offset in force in X, {offset:mm}, is not that of T{tool}: "
        "it cuts {off:fine} beside its words (G43 H{tool} after M6?)"
    ),
    "rapid-length": (
        "with the length of T{tool} in the table the tip goes by rapid to Z{level:mm}: "
        "the length in force is {length:mm} (G43 H{tool} missing?)"
    ),
    # holes
    "act-off-bottom": "{act} does not come at the bottom of the hole",
    "blended-hole": (
        "it is not in exact path mode (G61): C would turn before the tool is out of the hole"
    ),
    "clamp-open": "the clamp of C is open in the {what}: {code} does not come before it",
    "clamp-closed": "the clamp of C is not open for the {what}: {code} does not come before it",
    "clamp-left": "the clamp of C is closed after the holes: {code} does not come",
    # the material
    "rapid-through": "a rapid goes through material, from {at:xyz} to {to:xyz}",
    "rapid-into": "a rapid goes down into {area:mm2} of material, at {at:xyz}",
    "bar-remains": "{area:mm2} of the bar remain beyond the contour at Z{level:mm}",
    # sections
    "side-crossed": "the tool crosses the contour on its way in: {instead}?",
    "side-other": (
        "the tool is {here} the closed contour, it comes from {there}: {instead}? "
        "(else go {here} before the line with {code})"
    ),
    "zero-line-turned": (
        "C is where line {line} left it, turned by {turned:1}° against the cut of line {cut}: "
        "G0 C0 missing?"
    ),
    "above-start": (
        "its contour at {letter}{level:mm} lies above {letter}{start:mm}, where the tool comes "
        "from: it cuts air{hint}"
    ),
    "c-speed": "C turns at {made:2} degrees/s, its limit is {limit:2}",
    "c-turned-too-far": (
        "C turns by {turned:1}° in place at the centre: half a turn is the most it needs"
    ),
    "blended-in": "the section begins while the move before it slows down",
    "blended-out": "the section ends while the move after it begins",
    "blended-turn": "the tool goes on while C turns in place",
    "blended-corner": "a corner without an exact stop is rounded by {off:fine} or more",
    "stops-inside": "the tool stops inside a line or an arc",
    "not-exact": "the block does not end in the exact stop that its words ask for",
    "face-acceleration": "{axis} would need {times:2} times its acceleration here",
    "act-missing": "{act} does not come",
    "act-extra": "{act} comes {found}, where the program does not have it",
    "act-elsewhere": "{act} comes {found}, not {expected}",
}
NOTES = {
    "bored-assumed": (
        "a hole of radius {radius:length} at {at:xyz} counts as bored before: {why}{more:also}; "
        "--stock gives the real stock"
    ),
    "core-remains": (
        "{area:mm2} of material remain in its middle{more:also}: right only where it is to stay, "
        "or is bored before (--stock 'bore DIAMETER')"
    ),
    "cuts-wall": (
        "its cut at {at:xyz} and that of line {line} at {other:xyz} go into each other's walls"
    ),
    "cut-before": "all of it was cut before{more:also}: a spring pass, or the wrong place?",
    "never-run": (
        "{code} is never run{more:also}: the program ends before it, jumps over it, or block "
        "delete skips it"
    ),
    "empty": "{code} has nothing to cut: no line of it moves the tool",
    "offset-left": (
        "{code} is in force at the program's end: the next one begins with its zero shifted; "
        "G92.1 ends it"
    ),
    "beyond-axis": "its lowest X is {size:fine} beyond the part's axis",
    "tap-undrilled": "the tap goes into material, deeper than all cuts before it{more:also}",
    "start-in-cut": "before this line the spindle starts ({code}) with the tool in a cut: retract",
    "above-surface": (
        "nothing of it goes below its surface of radius {radius:mm}: it stays {size:fine} above"
    ),
    "plunge-into-stock": "it plunges with {share:0} % of the cutter into the stock, at {at:xyz}",
    "over-the-edge": "a portion of it lies outside of the stock",
    "no-stock-met": "it meets nothing of the stock",
    "inside-surface": (
        "{code} begins {inside:fine} inside of its surface of radius {radius:mm}: "
        "a rapid into it, or is its C a diameter? ([G12] CYLINDER_WORD)"
    ),
    "below-block": "the lowest cut is {size:fine} below the block",
    "contour-unread": (
        "nothing of the section is judged: its contour cannot be read from the words, {why}"
    ),
    "zero-line-unknown": (
        "no C word comes before the section: its zero line is where C is, at {angle:3}°"
    ),
    "zero-line-left": (
        "C is where line {line} left it: the contour begins turned on the part by {turned:1}°; "
        "G0 C0 missing?"
    ),
    "not-below-start": "no move goes below the {letter} of {code}",
    "rubs": (
        "C turns in place at the centre, by {degrees:1}° in all: there the tool rubs for "
        "{seconds:1} s"
    ),
    "cuts-contour": "the tool cuts {size:fine} into the contour of line {line}",
    "goes-back": "goes back along line {line}: under {code} the tool cuts both sides of that line",
    "change-in-cut": "T{tool} is changed with the tool below the part's top: retract before M6",
    "boss-cut": "nothing of the boss remains at Z{level:mm}: other cuts remove it",
    "no-diameter": "the tool has no diameter: only the toolpath of its centre is measured",
    "length-higher": (
        "the tool length in force, {offset:mm}, is not that of T{tool}: "
        "it cuts {off:fine} higher than its words say (G43 H{tool} after M6?)"
    ),
    "length-not-used": (
        "no tool length is in force (no G43, H0 or G49): that of T{tool} in the table, {off:fine}, "
        "is not used; right only where Z was touched off with this tool"
    ),
    "rapid-length-not-used": (
        "with the length of T{tool} in the table the tip goes by rapid to Z{level:mm}: "
        "the length in force is {length:mm} (G49)"
    ),
    "length-commanded": (
        "the tool length in force, {offset:mm} by {code}, is not that of T{tool} in the table: "
        "it cuts {off:fine} {where} than with G43"
    ),
    "feed-per-revolution": "a feed or pitch of {feed:fine} a revolution: was it meant per minute?",
    "feed-per-minute": "F is {feed:feed} here (G94): was it meant per revolution?",
    "feed-cut-down": "a feed of {feed:feed}, the machine's limits allow {most:feed}",
    "native-c": (
        "C turns together with X or Z outside of a section, where F counts for X and Z alone: "
        "the part's edge sees {feeds:feeds}"
    ),
    "return-level": (
        "{code} outside of a section is a return level of drilling cycles to LinuxCNC, "
        "no feed mode: write {meant}"
    ),
    "spindle-off": (
        "the spindle does not turn here: write S and M3 before this line, "
        "and M3 again after an M5 or M6"
    ),
    "spindle-m4": "the spindle turns counterclockwise (M4): right-hand tools cut with M3",
    "tool-spindle": (
        "the driven tool does not turn: no M3 or M4 with an S is in force here, M5 and M6 end it; "
        "right only where another code of the machine starts it"
    ),
    "main-spindle-turns": "the main spindle turns at {code}: C cannot hold a part that turns",
    "place-not-set": (
        "{code}.1 was never set on this machine: {code} is one rapid, its axes together, "
        "to machine zero; jog where tools are changed and run {code}.1 in MDI once"
    ),
    "side-cancelled": (
        "G40, but no G41 or G42 before it in the section: the tool's centre is on the contour"
    ),
    "contour-above": "its contour at {letter}{level:mm} stays above the part, others are below",
    "above-zero": "nothing of it goes below the program's Z0: its lowest Z is {level:mm} above",
    "travel-perhaps": (
        "with no work offset the {axis} axis would go to {position:mm}, its limit is {limit:length}"
    ),
    "travel-unknown": (
        "its travel is not known: with the machine's var file the program moves otherwise"
    ),
    "centre-on-circle": (
        "the tool's centre goes round on the circle, the wall is a tool radius farther"
    ),
    "loaded-unknown": "T{tool} has no diameter: measured with the diameter of D{named}",
    "none-loaded": (
        "no tool is loaded, T and M6 are missing: measured with the diameter of D{named}"
    ),
    "worn-cutter": (
        "the loaded tool T{tool} (⌀ {loaded:mm}) is not D{named} (⌀ {diameter:mm}): "
        "measured with the cutter of D{named}"
    ),
}
NOT_JUDGED = {
    "clamp-unseen": (
        "the clamp of C: no trace shows {codes}; both have to be remapped to a sub (ngc=)"
    ),
    "rapid-from-unknown": "rapids from an unknown start to a point below the part's top or Z0",
    "rapid-beside": (
        "rapids below the part's top or Z0, beside or below what is cut; --stock defines the"
        " material there"
    ),
    "rapid-after-cuts": "rapids from the side to where other cuts may have removed the bar before",
    "rapid-no-diameter": "rapids below the top, of a tool without a diameter",
    "rapid-idle-tool": "rapids below Z0 of tools that cut no section, shape or hole",
    "rapid-turned": "rapids of a tool between cuts on the face and in the side",
    "rapid-by-machine": "rapids by G53, G28 or G30 that begin below the part's top",
    "travel-unplaced": (
        "whether the cuts are within the travel: no work offset is set; --var gives the machine's"
    ),
    "tool-spindle-unseen": (
        "whether the driven tool turns: LinuxCNC's preview shows the first spindle alone"
    ),
    "upright": "the material around a circle in another plane than G17",
    "block-delete": "the program with block delete off: a preview skips what begins with /",
    "tool-table-set": (
        "cuts with the sizes of this G10 L1, L10 or L11: with a random tool changer LinuxCNC's "
        "preview keeps those of the loaded tool"
    ),
    "plain-moves": "feed moves outside of cycles and sections",
}
