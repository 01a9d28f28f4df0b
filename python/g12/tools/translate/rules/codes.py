# SPDX-License-Identifier: GPL-2.0-or-later
"""G and M codes, by their meanings in the control's file."""

from collections.abc import Mapping
from typing import Any

from g12.tools.translate.blocks.control import MEANINGS, PLACES
from g12.tools.translate.blocks.draft import Draft
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.lexer import ForeignWord

RULES = frozenset((*MEANINGS["G"], *MEANINGS["M"]))
BUILDERS = frozenset(("machine", *PLACES))
SPINDLES = {"$live": "$1", "$all": "$-1"}  # where the machine is not known


def keep_as_comments(draft: Draft) -> None:
    """Make comments of the codes that need nothing done, and of the words that are theirs."""
    for word in [word for word in draft.words if word.code]:
        meaning, *letters = draft.control.meanings.get(word.code, "").split(" ")
        if meaning != "comment" or draft.control.is_machines(word.code):
            continue
        own = [w for w in draft.words if w.letter in letters]
        draft.drop([word, *own])
        draft.comments.append(" ".join([word.code, *(w.text for w in own)]))


def map_codes(draft: Draft) -> None:
    """Replace every code, keep it, hand it to its rule, or refuse it."""
    _part_builders_codes(draft)
    named: Mapping[str, Any] = draft.control.tables.get("words", {})
    live = _speed_by_p(draft)
    words: list[ForeignWord] = []
    for word in draft.words:
        if word.letter in "GM":
            words += mapped(draft, word)
        else:
            words.append(word._replace(letter=named.get(word.letter, word.letter)))
    draft.words = [*words, *live]


def _speed_by_p(draft: Draft) -> list[ForeignWord]:
    """Take a code whose P is a speed out, ``M133 P1500``; return LinuxCNC's words for it."""
    meanings = draft.control.meanings
    word = next((w for w in draft.words if "S=P" in meanings.get(w.text, "")), None)
    if not word or draft.control.is_machines(word.text):
        return []
    draft.drop([word])
    speed = draft.take("P")
    return _own_words(meanings[word.text].replace("S=P", f"S{speed.value}" if speed else ""))


def _own_words(meaning: str) -> list[ForeignWord]:
    texts = (SPINDLES.get(text, text) for text in meaning.split())
    return [ForeignWord(text[0], text[1:]) for text in texts]


def _part_builders_codes(draft: Draft) -> None:
    """Write all builder's codes but the last on lines before: LinuxCNC takes one in a block."""
    found = [w for w in draft.words if w.code[:1] == "M" and is_own(draft, w)]
    for word in found[:-1]:
        draft.before += [one.text for one in mapped(draft, word)]
        draft.drop([word])


def is_own(draft: Draft, word: ForeignWord) -> bool:
    """Whether a code is one that the machine has besides LinuxCNC's."""
    meaning = draft.control.meanings.get(word.code, "")
    known = draft.control.is_machines(word.code) or draft.control.is_machines(meaning)
    return (known and meaning not in RULES) or meaning in BUILDERS


def mapped(draft: Draft, word: ForeignWord) -> list[ForeignWord]:
    if word.kind != "number":
        raise NotTranslated(f"{word.letter}{word.value}: a code must be a number")
    code, control = word.code, draft.control
    meaning = control.meanings.get(code, "")
    if meaning in RULES:
        if meaning in draft.meanings:
            raise NotTranslated(f"{draft.meanings[meaning].code} and {code} in one block")
        draft.meanings[meaning] = word
        return []
    if meaning == "same" or control.is_machines(code):
        return [word]
    if meaning in BUILDERS and control.on_machine:
        raise NotTranslated(
            f"{code} is the machine builder's, and this machine has neither a REMAP line nor "
            f"a file for it: say under [m_codes] of your control what it does"
        )
    if meaning.startswith("refuse: "):
        raise NotTranslated(f"{code}: {meaning.removeprefix('refuse: ')}")
    if not meaning:
        table = f"[{code[0].lower()}_codes]"
        raise NotTranslated(f"{code} is not known of {control.name}: say under {table} what it is")
    return [word] if meaning in BUILDERS else _own_words(meaning)
