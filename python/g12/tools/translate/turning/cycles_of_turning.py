# SPDX-License-Identifier: GPL-2.0-or-later
"""Turning cycles written out as moves: exact on every LinuxCNC, which has none or other ones.

Two-block forms store the values of their first block; a one-block form has all. Single passes are
modal: blocks of X, Z, U and W alone repeat them from the same start.
"""

from collections.abc import Callable, Sequence
from typing import Any

from g12.tools.translate.blocks.draft import Draft, word_of
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.modal import (
    AS_PROGRAMMED,
    CONSUMERS,
    MOTIONS,
    UNKNOWN,
    UNSURE,
)
from g12.tools.translate.blocks.positions import FIELDS
from g12.tools.translate.rules.motion import in_absolute_words, needs_g90
from g12.tools.translate.rules.polar import own_feed_ended
from g12.tools.translate.rules.tools import COMPENSATION_ON, offsets_radius
from g12.tools.translate.turning.given_words import (
    named_blocks,
    read_contour,
    start_point,
    stored_setting,
    take_end,
    take_increments,
    take_number,
    take_whole,
)
from g12.tools.translate.turning.moves import (
    CycleMove,
    Infeed,
    Pecking,
    Thread,
    all_passes,
    finishing_cut,
    lines_of_moves,
    pecks,
    pitch_along,
    single_pass,
    thread_pass,
)
from g12.tools.translate.turning.roughing import RoughCuts, rough

SHORTEST = 1e-5  # of a thread
BESIDE_SINGLE_PASS = frozenset("NGMSTF$")  # may be in a cycle's block


def no_pass_yet(draft: Draft) -> None:
    """Keep a G90 as a comment where a move's code ends it: absolute, too, where it is a mode.

    Of two codes of a group the last one counts; a G90 without X and Z cuts nothing yet.
    """
    code = draft.meanings.get("turning pass")
    if not code:
        return
    order = [word.code for word in draft.block.words if word.letter == "G"]
    moves = [at for at, one in enumerate(order) if one in MOTIONS]
    ended = moves[-1:] > [order.index(code.code)]
    if not ended and (moves or (len(draft.meanings) == 1 and _has_own_words(draft))):
        return
    del draft.meanings["turning pass"]
    draft.change(turning_cycle=UNKNOWN if ended else "turning pass", pass_words=())
    draft.comments.append(code.text)


def turning_cycle(draft: Draft) -> None:
    _follow_chamfers(draft)
    meaning = next((name for name in draft.meanings if name in CYCLES), "")
    modal = draft.state.turning_cycle
    if not meaning and modal:
        codes = set(draft.codes())
        if codes & MOTIONS or draft.meanings:
            draft.change(turning_cycle=UNKNOWN)
        elif _has_own_words(draft):
            meaning = draft.sure("turning_cycle", "X and Z may repeat a turning cycle")
    if not meaning:
        return
    if draft.state.polar != "off":
        raise NotTranslated("a turning cycle in a section: end the section before it")
    if draft.state.plane not in ("G18", UNKNOWN):
        raise NotTranslated("a turning cycle needs the plane of X and Z: write G18 before it")
    if draft.sure("x_words", "X of a turning cycle is a diameter") != "G7":
        raise NotTranslated("a turning cycle where X words are radii: write G10.9 X1 before it")
    if meaning != modal:
        draft.change(turning_cycle=UNKNOWN)
    CYCLES[meaning](draft, meaning)
    draft.meanings.pop(meaning, None)


def _has_own_words(draft: Draft) -> bool:
    """Whether X Z U W are the cycle's, not those of a code such as G28."""
    taken = {*CONSUMERS, "G53"}.intersection(draft.codes())
    return bool(draft.letters() & set("XZUW")) and not taken


def _follow_chamfers(draft: Draft) -> None:
    """M23 and M24 of a Haas: whether threads end with a chamfer."""
    for name, value in (("thread chamfer", True), ("no thread chamfer", False)):
        if code := draft.meanings.pop(name, None):
            draft.comments.append(code.code)
            draft.change(chamfers=value)


def _write_moves(draft: Draft, moves: Sequence[CycleMove], start: complex, **modes: Any) -> None:
    """Write moves after the block's other words; they end at the start point."""
    _refuse_strange(draft, "in the block of a turning cycle")
    own = AS_PROGRAMMED if draft.state.motion == "G0" else "G0"
    draft.before += own_feed_ended(draft)
    draft.after += ["G90"] if needs_g90(draft) else []
    draft.after += lines_of_moves(moves, start)
    draft.comments += [word.text for word in draft.meanings.values()]
    draft.change(own_motion=own, at_x=2 * start.imag, at_z=start.real)
    draft.change(**modes)


def _refuse_strange(draft: Draft, where: str) -> None:
    """Refuse a word that the cycle has not taken: LinuxCNC would give it another meaning."""
    strange = next((word for word in draft.words if word.letter not in BESIDE_SINGLE_PASS), None)
    if strange:
        raise NotTranslated(f"{strange.text} is not understood {where}")


def keep(draft: Draft, meaning: str, **values: float | None) -> None:
    """Store the values of a cycle's first block for its second."""
    code = draft.meanings[meaning].code
    _refuse_strange(draft, f"in the first block of {code}")
    stored = {name: value for name, value in values.items() if value is not None}
    kept = {**dict(draft.state.kept), **{f"{meaning} {n}": v for n, v in stored.items()}}
    positions = {name: getattr(draft.start, name) for name in FIELDS.values()}
    draft.change(kept=tuple(sorted(kept.items())), **positions)
    draft.comments.append(", ".join([code, *(f"{n} {v:g}" for n, v in stored.items())]))


def _kept_value(draft: Draft, meaning: str, name: str) -> float:
    """Return the stored value of a first block, or the control's setting."""
    kept = dict(draft.state.kept).get(f"{meaning} {name}")
    if kept == UNSURE:
        raise NotTranslated(f"the {name} here is not the same on every way: say it in this cycle")
    return stored_setting(draft, name) if kept is None else kept


# ---------------------------------------------------------------- along a contour


def roughing(draft: Draft, meaning: str) -> None:
    """G71 and G72."""
    along_x = meaning.endswith("X")
    depth_word = "W" if along_x else "U"
    if draft.letters().isdisjoint("PQ"):
        keep(draft, meaning, depth=take_number(draft, depth_word), retract=take_number(draft, "R"))
        return
    start, (indices, follows) = start_point(draft), _contour_named(draft)
    depth = take_increments(draft, "D") or _kept_value(draft, meaning, "depth")
    take_whole(draft, "R")  # Haas: 1 for type II, which the contour itself shows
    retract, allowance = (
        _kept_value(draft, meaning, "retract"),
        complex(take_number(draft, "W") or 0.0, (take_number(draft, "U") or 0.0) / 2),
    )
    if depth <= 0:
        code = draft.meanings[meaning].code
        raise NotTranslated(
            f"{code} needs a depth of cut above 0: {depth_word} in its first block, or D"
        )
    segments, _ = read_contour(draft, indices, start)
    given = RoughCuts(depth, retract, allowance, along_x, segments[0].code)
    _write_uncompensated(draft, rough(start, segments, given), start)
    draft.follows = follows


def _contour_named(draft: Draft) -> tuple[range, int]:
    """Take P and Q; return the contour's blocks, and the block after the cycle."""
    first, last = take_whole(draft, "P"), take_whole(draft, "Q")
    if first is None or last is None:
        raise NotTranslated("the cycle needs P and Q, the first and the last block of its contour")
    return named_blocks(draft, first, last)


def _write_uncompensated(draft: Draft, moves: Sequence[CycleMove], start: complex) -> None:
    """Write moves without nose compensation; it is restored after them."""
    on = draft.sure("compensation", "roughing is not compensated")
    _write_moves(draft, moves, start, motion=UNSURE, own_motion=UNSURE)
    if on in COMPENSATION_ON:
        radius = (word.text for word in offsets_radius(draft))
        draft.after = ["G40", *draft.after, " ".join([on, *radius])]


def finishing(draft: Draft, meaning: str) -> None:
    """G70: the contour with its own feeds, speeds and compensation."""
    start, (indices, follows) = start_point(draft), _contour_named(draft)
    needless = [word.text for word in draft.take_each("UWD")]
    draft.comments += [f"{' '.join(needless)}: nothing for a finishing cut"] if needless else []
    before = draft.sure("compensation", "finishing takes over")
    segments, state = read_contour(draft, indices, start)
    moves = finishing_cut(start, segments)
    if state.compensation not in (before, "G40"):
        back = len(segments)  # the first move after the contour
        moves[back : back + 1] = [m._replace(others=("G40",)) for m in moves[back : back + 1]]
        state = state._replace(compensation="G40")
    kept = {n: getattr(state, n) for n in ("feed", "feed_mode", "compensation", "spindle_mode")}
    _write_moves(draft, moves, start, **kept, motion=UNSURE, own_motion=UNSURE)
    draft.follows = follows


# ---------------------------------------------------------------- pecks, passes, threads


def pecking(draft: Draft, meaning: str) -> None:
    """G74 and G75: two blocks, or Haas's one with I and K."""
    if draft.letters().isdisjoint("XZUW"):
        keep(draft, meaning, retract=take_number(draft, "R"))
        return
    start = start_point(draft)
    end = take_end(draft, start)
    x_step = take_number(draft, "I") or take_increments(draft, "P") or 0.0
    z_step = take_number(draft, "K") or take_increments(draft, "Q") or 0.0
    if take_number(draft, "R") or take_number(draft, "D"):
        raise NotTranslated("a shift at the bottom of a peck, R or D: take it out, for clear pecks")
    along_x = meaning.endswith("X")
    peck, step = (x_step, z_step) if along_x else (z_step, x_step)
    there = complex(end.get("Z", start.real), end.get("X", start.imag))
    retract = _kept_value(draft, meaning, "retract")
    given = Pecking(there, abs(peck), abs(step), retract, along_x)
    _write_moves(draft, pecks(start, given), start)


def _modal_pass(draft: Draft, meaning: str) -> None:
    """G90, G94 and G92 of system A."""
    start, end, taper = _pass_words(draft, meaning)
    if meaning == "thread pass":
        thread = Thread(end, _lead_of(draft), taper, _chamfer_of(draft))
        moves = thread_pass(start, thread)
    else:
        moves = single_pass(start, end, taper, meaning == "facing pass")
    _write_moves(draft, moves, start, turning_cycle=meaning)


def _pass_words(draft: Draft, meaning: str) -> tuple[complex, complex, float]:
    """Return start, end and taper of a modal cycle; missing words are those of the block before."""
    code = draft.meanings.get(meaning)
    if code and (set(draft.codes()) & MOTIONS or draft.letters().isdisjoint("XZUW")):
        raise NotTranslated(_other_meaning(code.code, meaning))
    start = start_point(draft)
    again = draft.start.turning_cycle == meaning and meaning not in draft.meanings
    own = take_end(draft, start)
    tapers = [
        take_number(draft, letter) for letter in ("R", "K" if meaning == "facing pass" else "I")
    ]
    taper = next((number for number in tapers if number is not None), None)
    stored: Any = (
        draft.sure("pass_words", "the cycle takes the words of the block before") if again else ()
    )
    if again and not stored:
        own_code = next(code for code, of in draft.control.meanings.items() if of == meaning)
        raise NotTranslated(_other_meaning(own_code, meaning))
    words = {**dict(stored), **own}
    words.update({} if taper is None else {"R": taper})
    if not {"X", "Z"} <= words.keys():
        raise NotTranslated("the cycle needs X and Z, where its cut ends")
    draft.change(pass_words=tuple(sorted(words.items())))
    return start, complex(words["Z"], words["X"]), words.get("R", 0.0)


def _other_meaning(code: str, meaning: str) -> str:
    """Return why a single pass is refused whose code is a mode in other G code systems."""
    return (
        f"{code} is a cycle here, the {meaning}, with X and Z and no G0 or G1: where it is a mode, "
        "the control is another of fanuc-lathe, fanuc-lathe-b and fanuc-lathe-c; else take it out"
    )


def _lead_of(draft: Draft) -> float:
    missing = "a thread needs F, its lead, as a number"
    try:
        lead = float(draft.sure("feed", missing))
    except ValueError:
        lead = 0.0
    if lead <= 0:
        raise NotTranslated(missing)
    return lead


def _chamfer_of(draft: Draft) -> float:
    if not draft.sure("chamfers", "a thread may end with a chamfer"):
        return 0.0
    return float(draft.control.value("turning", "thread_chamfer", 0.0)) * _lead_of(draft)


def threading(draft: Draft, meaning: str) -> None:
    """G76: Fanuc's two blocks, or Haas's one with K and D."""
    if draft.letters().isdisjoint("XZUW"):
        _keep_thread(draft)
        return
    start = start_point(draft)
    end = take_end(draft, start)
    if not {"X", "Z"} <= end.keys():
        raise NotTranslated("G76 needs X and Z, where the thread ends")
    haas = "K" in draft.letters()
    infeed, chamfer = _haas_infeed(draft) if haas else _fanuc_infeed(draft)
    taper = take_number(draft, "I" if haas else "R") or 0.0
    thread = Thread(complex(end["Z"], end["X"]), _lead_of(draft), taper, chamfer)
    _write_moves(draft, all_passes(start, thread, infeed), start)


def _keep_thread(draft: Draft) -> None:
    """Store the first block of Fanuc's G76: P is three numbers of two digits."""
    packed = take_whole(draft, "P")
    values = {"least": take_increments(draft, "Q"), "allowance": take_number(draft, "R")}
    if packed is not None:
        values["finishing"] = float(packed // 10000)
        values["chamfer"] = packed // 100 % 100 / 10
        values["angle"] = float(packed % 100)
    keep(draft, "threading", **values)


def _fanuc_infeed(draft: Draft) -> tuple[Infeed, float]:
    """Return the infeed and the chamfer."""
    value = lambda name: _kept_value(draft, "threading", name)  # noqa: E731
    height, first = take_increments(draft, "P") or 0.0, take_increments(draft, "Q") or 0.0
    finishing_passes = int(value("finishing")) or 1
    infeed = Infeed(height, first, value("least"), value("allowance"), finishing_passes)
    return infeed._replace(angle=value("angle")), value("chamfer") * _lead_of(draft)


def _haas_infeed(draft: Draft) -> tuple[Infeed, float]:
    """Return the same for Haas's K, D and A."""
    height, first = take_number(draft, "K") or 0.0, take_increments(draft, "D") or 0.0
    angle, method = take_number(draft, "A") or 0.0, take_whole(draft, "P") or 1
    if method != 1:
        raise NotTranslated(f"G76 P{method}: write P1: one flank, the same chip in each pass")
    least, allowance = (stored_setting(draft, f"thread_{n}") for n in ("least", "allowance"))
    return Infeed(height, first, least, allowance, 1, angle), _chamfer_of(draft)


def _thread_move(draft: Draft, meaning: str) -> None:
    """G32: G33 with the lead as the travel along its path."""
    start = start_point(draft)
    end = take_end(draft, start)
    there = complex(end.get("Z", start.real), end.get("X", start.imag))
    if abs(there - start) < SHORTEST:
        raise NotTranslated("the thread has no length")
    pitch = pitch_along(there - start, _lead_of(draft))
    _refuse_strange(draft, "beside a thread")
    feed = draft.take("F")
    draft.before += [feed.text] if feed else []  # LinuxCNC has no F beside G33
    (line,) = lines_of_moves([CycleMove("G33", there, None, pitch)], start)
    draft.words += [word_of(text) for text in line.split()]
    in_absolute_words(draft)
    draft.has_motion = True
    draft.change(
        turning_cycle=meaning,
        motion="G33",
        own_motion=AS_PROGRAMMED,
        at_x=2 * there.imag,
        at_z=there.real,
    )


CYCLES: dict[str, Callable[[Draft, str], None]] = {
    "roughing along Z": roughing,
    "roughing along X": roughing,
    "finishing": finishing,
    "pecking along Z": pecking,
    "pecking along X": pecking,
    "turning pass": _modal_pass,
    "facing pass": _modal_pass,
    "thread pass": _modal_pass,
    "threading": threading,
    "thread": _thread_move,
}
