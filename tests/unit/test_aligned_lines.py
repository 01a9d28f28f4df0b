# SPDX-License-Identifier: GPL-2.0-or-later
"""Which line of a file a line that a filter has written comes from."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from g12.tools.machine.aligned_lines import aligned_lines
from support.growth import growth

FILE = ["%", "O1", "G0 X1", "G1 X2", "G1 X3", "M30", "%"]


@pytest.mark.parametrize(
    ("written", "lines"),
    [
        (["(head)", *FILE], (1, 1, 2, 3, 4, 5, 6, 7)),
        (["a", "b", "c", "d", "e", "f", "g"], (1, 2, 3, 4, 5, 6, 7)),  # each line in its place
        (["%", "O1", "G0 X1", "X1.5", "X2", "G1 X3", "M30", "%"], (1, 2, 3, 4, 4, 5, 6, 7)),
        (["%", "O1", "A", "B", "C", "D", "M30", "%"], None),  # two lines have become four
        ([], ()),
    ],
)
def test_lines_are_found(written, lines):
    rows = [row.encode() for row in FILE]
    assert aligned_lines(rows, [row.encode() for row in written]) == lines


def test_a_block_number_names_its_line():
    assert aligned_lines(
        [b"N10 G7 X1.5 $", b"N20 G0 X2 $"],
        [b"G17 G40", b"N10 o<a> call [1]", b"(more)", b"N20 o<a> call [2]", b"M2"],
    ) == (1, 1, 1, 2, 2)


def test_repeated_lines_within_what_a_filter_adds_are_no_anchors():
    source = [b"G12 I5", b"G0 Z5", b"G12 I6", b"G0 Z6"]
    moves = [b"G1 X5", b"G0 Z5", b"G2 I-5", b"G0 Z5", b"G1 X6", b"G0 Z5", b"G2 I-6", b"G0 Z6"]
    assert aligned_lines(source, moves) is None


ROWS = st.lists(st.sampled_from([b"G0 X1", b"G0 X2", b"N5 G1", b"", b"M30", b"%"]), max_size=12)


@given(ROWS, ROWS)
def test_lines_exist_and_never_go_back(source, written):
    lines = aligned_lines(source, written)
    assert lines is None or len(lines) == len(written)
    assert list(lines or ()) == sorted(lines or ())
    assert all(1 <= line <= len(source) for line in lines or ())


@given(ROWS, st.integers(0, 12), ROWS)
def test_lines_put_in_leave_the_others_known(source, at, added):
    written = [*source[:at], *added, *source[at:]]
    lines = aligned_lines(source, written)
    if lines is not None and len(source) == len(set(source)) and not set(added) & set(source):
        assert [lines[n] for n in range(min(at, len(source)))] == list(
            range(1, min(at, len(source)) + 1)
        )


@pytest.mark.parametrize("row", [b"G1 X%d", b"G1 X1 (%d)", b"G0"])
def test_lines_are_not_compared_each_with_each(row):
    def aligned(count):
        source = [row % n if b"%" in row else row for n in range(count)]
        return lambda: aligned_lines(source, [b"(head)", *source])

    assert aligned(9)() == (1, *range(1, 10))
    assert growth(aligned, 10_000) < 10
