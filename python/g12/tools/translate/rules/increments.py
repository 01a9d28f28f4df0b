# SPDX-License-Identifier: GPL-2.0-or-later
"""U V W H of a lathe: increments of X Y Z C beside absolute words.

A block of increments alone goes under G91, and the next block of words goes back. Beside absolute
words an increment is written from where the tool stands. Between polar on and off U and H are
words of LinuxCNC's polar mode and stay, on a cylinder W is, too.
"""

from g12.tools.translate.blocks.draft import PARTNERS, Draft
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.lexer import ForeignWord
from g12.tools.translate.blocks.places import known_place, value_text
from g12.tools.translate.rules.reference import place_of_increment


def incremental_words(draft: Draft) -> None:
    """Rewrite the increments of a block."""
    if not draft.control.is_lathe or draft.meanings:
        return
    found = draft.increments()
    if draft.state.polar != "off":
        own = "UH" if draft.state.polar == "on" else "UWH"
        found = [word for word in found if word.letter not in own]
        if found and len(draft.axis_words()) + len(draft.increments()) > len(found):
            _depth_in_section(draft, found[0])
            return
    if not found:
        return
    for word in found:
        if PARTNERS[word.letter] in draft.letters():
            raise NotTranslated(f"{word.text} and {PARTNERS[word.letter]} in one block")
    alone = len(found) == len(draft.axis_words()) + len(found)
    if draft.sure("distance", f"{found[0].text} is an increment") == "G91":
        _rename(draft)
    elif alone:
        _rename(draft)
        draft.change(own_distance="G91")
        draft.put_first("G91")
    else:
        for word in found:
            draft.replace(word, place_of_increment(draft, word))


def _depth_in_section(draft: Draft, word: ForeignWord) -> None:
    """Write W beside X and C of a section as Z, which is not in the section's plane."""
    if word.letter != "W" or {"Z"} & draft.letters():
        raise NotTranslated(f"{word.text} beside other axes in a section")
    depth = known_place(draft.state, "Z")
    if draft.sure("distance", f"{word.text} is an increment") == "G91":
        draft.replace(word, word._replace(letter="Z"))
    elif depth is None:
        value = f"[#5422 + [{word.value}]]"
        draft.replace(word, ForeignWord("Z", value, "expression"))
    else:
        draft.replace(word, ForeignWord("Z", value_text(depth)))


def _rename(draft: Draft) -> None:
    for word in draft.increments():
        draft.replace(word, word._replace(letter=PARTNERS[word.letter]))
