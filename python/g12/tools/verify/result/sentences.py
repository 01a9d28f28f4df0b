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
        "its depth Z{depth:mm} lies above Z{start:mm}, where the tool comes from: "
        "it cuts air (a lost minus sign?)"
    ),
    "travel": "the {axis} axis would go to {position:mm}, its limit is {limit:length}",
    # the tool
    "length-deeper": (
        "the tool length in force, {length:mm}, is not that of T{tool}: "
        "it cuts {off:fine} deeper than its words say (G43 H{tool} after M6?)"
    ),
    # the material
    "rapid-through": "a rapid goes through material, from {at:place} to {to:place}",
    "rapid-into": "a rapid goes down into {area:mm2} of material, at {at:place}",
    "bar-remains": "{area:mm2} of the bar remain beyond the contour at Z{level:mm}",
    "said": "{text:said}",
}
NOTES = {
    "bored-assumed": (
        "a bored hole is assumed down to {at:place}, for a rapid or R goes there{more}: "
        "--stock gives what there is"
    ),
    "plunge-into-stock": (
        "it plunges with {share:0} % of the cutter into the stock, at {at:place}{of}"
    ),
    "no-stock-met": "it meets nothing of the stock",
    "inside-surface": (
        "{code} begins {inside:fine} inside of its surface of radius {radius:mm}: "
        "is its C a diameter? ([G12] CYLINDER_WORD)"
    ),
    "below-block": "the lowest cut is {size:fine} below the block",
    "length-higher": (
        "the tool length in force, {length:mm}, is not that of T{tool}: "
        "it cuts {off:fine} higher than its words say (G43 H{tool} after M6?)"
    ),
    "length-not-used": (
        "no G43: the tool table's length of T{tool}, {off:fine}, is not used; "
        "right only where Z was touched off with this tool"
    ),
    "feed-per-revolution": "F is {feed:mm} per revolution here (G95): was it meant per minute?",
    "feed-per-minute": "F is {feed:feed} here (G94): was it meant per revolution?",
    "feed-cut-down": "F asks for {feed:feed}, the machine's limits allow {most:feed}",
    "native-c": (
        "C turns together with X or Z outside of a section, where F counts for X and Z alone: "
        "the part's edge sees {least:feed} to {most:feed}"
    ),
    "return-level": (
        "{code} outside of a section is a return level of drilling cycles to LinuxCNC, "
        "no feed mode: write {meant}"
    ),
    "spindle-stands": (
        "the spindle stands still: no M3 or M4 with an S comes before it, "
        "or M5 or M6 comes after them"
    ),
    "spindle-m4": "the spindle turns counterclockwise (M4): right-hand tools cut with M3",
    "main-spindle-turns": "the main spindle turns at {code}: C cannot hold a part that turns",
    "above-zero": "nothing of it goes below the program's Z0: its lowest Z is {level:mm} above",
    "noted": "{text:said}",
}
NOT_JUDGED = {
    "first-rapid": (
        "what the first rapid goes through on its way to {at:place}: "
        "where the tool comes from is not known"
    ),
    "plain-moves": (
        "feed moves outside of cycles and sections: {count} lines, the last of them line {last}"
    ),
}
