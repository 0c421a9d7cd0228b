"""Writes switches into a source: `shapeid_mutant(n)` is true while mutant n lives."""

INCLUDE = '#include "shapeid/models/mutant_switch.hpp"\n'


def switched(number, place, original):
    """The place's text with its switch; `original` is its text with the switches of other mutants."""
    alive = f"shapeid_mutant({number})"
    changed = place.changed
    if place.form == "expression":
        return f"({alive} ? ({changed}) : ({original}))"
    if place.form == "negation":
        return f"({alive} != static_cast<bool>({original}))"
    if place.form == "deletion":
        return f"{{ if (!{alive}) {{ {original} }} }}"
    if place.form == "statement":
        return f"{{ if ({alive}) {{ {changed} }} else {{ {original} }} }}"
    if place.form == "initial":
        declared, changed = changed.split("|", 1)
        return f"({alive} ? {declared}({changed}) : {declared}({original}))"
    raise ValueError(place.form)


def pair(text, number, place, within):
    """`i, j` becomes `j, i`: two expressions, each with its own switch."""
    alive = f"shapeid_mutant({number})"
    second, first = place.changed.split("|", 1)
    end_of_first, start_of_second = place.start + len(first), place.end - len(second)
    i = inner(text, place.start, end_of_first, [m for m in within if m[1].end <= end_of_first])
    j = inner(text, start_of_second, place.end, [m for m in within if m[1].start >= start_of_second])
    return f"({alive} ? ({second}) : ({i})), ({alive} ? ({first}) : ({j}))"


def inner(text, start, end, mutants):
    """Text [start, end) with all `mutants` [(number, place)] inside. Where one lies in another, the
    inner one is switched where the outer one is dead; two that overlap otherwise do not occur, for
    they are nodes of one tree, but for a statement's semicolon."""
    result, at = "", start
    while mutants:
        first = mutants[0][1]
        same = [m for m in mutants if (m[1].start, m[1].end) == (first.start, first.end)]
        within = [m for m in mutants if m not in same and m[1].end <= first.end]
        mutants = [m for m in mutants if m not in same and m not in within]
        result += text[at:first.start]
        if first.form == "pair":
            written = pair(text, same[0][0], first, within)
        else:
            written = inner(text, first.start, first.end, within)
            for number, place in same:
                written = switched(number, place, written)
        result += written
        at = first.end
    return result + text[at:end]


def rewritten(text, mutants):
    """A whole source with the switches of `mutants`, a list of (number, place)."""
    ordered = sorted(mutants, key=lambda m: (m[1].start, -m[1].end, m[0]))
    return INCLUDE + inner(text, 0, len(text), ordered)
