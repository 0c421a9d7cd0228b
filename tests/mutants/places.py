"""Where a C++ source can be changed by one operator, and how: found in clang's syntax tree.

A change is only proposed where a switch at run time can choose between the original and the changed text
(an expression of the same type, or a whole statement), so that hundreds of mutants are compiled once.
Left alone: what is computed at compile time (constexpr, template arguments), contracts and functions that
return a Violation (debug builds check them), and the texts of errors.
"""
import bisect
import dataclasses
import re

from clang import cindex

Kind = cindex.CursorKind
Type = cindex.TypeKind

INTEGERS = {Type.INT, Type.UINT, Type.LONG, Type.ULONG, Type.LONGLONG, Type.ULONGLONG, Type.SHORT,
            Type.USHORT, Type.UCHAR, Type.SCHAR, Type.CHAR_S, Type.INT128}
ARITHMETIC = INTEGERS | {Type.DOUBLE, Type.FLOAT, Type.LONGDOUBLE}
BODIES = {Kind.COMPOUND_STMT, Kind.IF_STMT, Kind.FOR_STMT, Kind.CXX_FOR_RANGE_STMT, Kind.WHILE_STMT,
          Kind.CASE_STMT, Kind.DEFAULT_STMT}
FUNCTIONS = {Kind.FUNCTION_DECL, Kind.CXX_METHOD, Kind.CONSTRUCTOR, Kind.DESTRUCTOR, Kind.FUNCTION_TEMPLATE}

ARITHMETIC_SWAPS = {"+": "-", "-": "+", "*": "/", "/": "*", "%": "*"}
ASSIGNMENT_SWAPS = {"+=": "-=", "-=": "+=", "*=": "/=", "/=": "*="}
RELATION_SWAPS = {"<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "=="}
LOGIC_SWAPS = {"&&": "||", "||": "&&"}
CALL_SWAPS = {"sin": "cos", "cos": "sin", "min": "max", "max": "min", "floor": "ceil", "ceil": "floor",
              "front": "back", "back": "front", "minCoeff": "maxCoeff", "maxCoeff": "minCoeff",
              "norm": "squaredNorm", "squaredNorm": "norm", "rows": "cols", "cols": "rows",
              "any_of": "all_of", "all_of": "any_of", "lower_bound": "upper_bound",
              "upper_bound": "lower_bound"}
NUMBER = re.compile(r"(\d+(?:\.\d*)?(?:[eE][-+]?\d+)?)([uUlL]*)$")
# What stands in these parentheses is text for people, or is checked in debug builds only.
UNTOUCHED_CALLS = re.compile(
    r"\b(SHAPEID_CONTRACT|static_assert|fmt::format|InputError|Refusal|Defect|noexcept|alignas)\(")


@dataclasses.dataclass
class Place:
    """Text [start, end) of a file becomes `changed`; `form` says how the switch is written."""
    file: str
    start: int
    end: int
    form: str
    changed: str
    operator: str  # class of the change
    original: str
    line: int
    says: str  # what is replaced by what, for people


def matching(text, at, opening, closing):
    """The end of the bracket that opens at `at`."""
    depth = 0
    for i in range(at, len(text)):
        depth += (text[i] == opening) - (text[i] == closing)
        if depth == 0:
            return i + 1
    return len(text)


def untouched(text):
    """Ranges of `text` that are left alone wherever they stand."""
    ranges = []
    for call in UNTOUCHED_CALLS.finditer(text):
        ranges.append((call.start(), matching(text, call.end() - 1, "(", ")")))
    # The sources are formatted: a template's bracket follows its name at once, a relation has blanks.
    for bracket in re.finditer(r"[A-Za-z0-9_]<(?=[^<=\s])", text):
        ranges.append((bracket.start(), matching(text, bracket.end() - 1, "<", ">")))
    for word in re.finditer(r"\b(?:throw|case|using|#include)\b[^;:{]*"
                            r"|\bconstexpr\b(?:[^;{]*=\s*\{[^;]*|[^;{]*)", text):
        ranges.append(word.span())
    for comment in re.finditer(r"//[^\n]*", text):
        ranges.append(comment.span())
    return ranges


class Finder:
    def __init__(self, file, name, text, unit):
        self.file, self.name, self.unit = file, name, unit
        self.bytes = text.encode()
        self.text = text  # offsets are those of bytes; the sources are ASCII, which is checked
        self.lines = [0] + [i + 1 for i, c in enumerate(text) if c == "\n"]
        self.skip = untouched(text)
        self.found = []

    def places(self):
        for cursor in self.unit.cursor.get_children():
            if cursor.location.file and cursor.location.file.name == self.file:
                self.declarations(cursor)
        unique = {(p.start, p.end, p.form, p.changed): p for p in self.found}
        return sorted(unique.values(), key=lambda p: (p.start, p.end, p.changed))

    # --- walking ---

    def declarations(self, cursor):
        if cursor.kind in FUNCTIONS:
            if self.mutable_function(cursor):
                self.walk(cursor, [], cursor)
            return
        if cursor.kind in (Kind.NAMESPACE, Kind.CLASS_DECL, Kind.STRUCT_DECL, Kind.LINKAGE_SPEC,
                           Kind.UNEXPOSED_DECL):
            for child in cursor.get_children():
                self.declarations(child)

    def mutable_function(self, cursor):
        head = self.text[cursor.extent.start.offset:cursor.location.offset]
        return (cursor.is_definition() and "constexpr" not in head and "consteval" not in head
                and "Violation" not in head)

    def walk(self, cursor, above, function):
        for child in cursor.get_children():
            if child.kind == Kind.CXX_THROW_EXPR:
                continue
            if child.kind == Kind.LAMBDA_EXPR:
                self.walk(child, above + [cursor], None)  # no declared type of its result
                continue
            self.look(child, above + [cursor], function)
            self.walk(child, above + [cursor], function)

    def look(self, cursor, above, function):
        kind = cursor.kind
        if kind == Kind.BINARY_OPERATOR:
            self.binary(cursor)
        elif kind == Kind.COMPOUND_ASSIGNMENT_OPERATOR:
            self.binary(cursor)
        elif kind == Kind.UNARY_OPERATOR:
            self.unary(cursor, above)
        elif kind in (Kind.INTEGER_LITERAL, Kind.FLOATING_LITERAL):
            self.literal(cursor, above)
        elif kind == Kind.CXX_BOOL_LITERAL_EXPR:
            self.boolean(cursor)
        elif kind == Kind.CALL_EXPR:
            self.call(cursor, above, function)
        elif kind == Kind.IF_STMT:
            self.condition(cursor, "if (")
        elif kind == Kind.CONDITIONAL_OPERATOR:
            self.condition(cursor, "")
        elif kind == Kind.RETURN_STMT:
            self.returned(cursor, function)
        if above[-1].kind in BODIES:
            self.statement(cursor, above[-1])

    # --- helpers ---

    def span(self, cursor):
        return cursor.extent.start.offset, cursor.extent.end.offset

    def source(self, cursor):
        start, end = self.span(cursor)
        return self.text[start:end]

    def propose(self, start, end, form, changed, operator, says):
        if start == end:
            return  # of a loop over a range, where it is not written out
        if any(a < end and start < b for a, b in self.skip if not (start <= a and b <= end)):
            return  # inside what is left alone
        line = bisect.bisect_right(self.lines, start)
        self.found.append(Place(self.name, start, end, form, changed, operator,
                                self.text[start:end], line, says))

    def operator_between(self, left, right):
        """The operator's token and its place, between two operands."""
        start, end = left.extent.end.offset, right.extent.start.offset
        gap = self.text[start:end]
        token = gap.strip(" \n()")
        return (token, start + gap.index(token)) if token else (None, start)

    @staticmethod
    def arithmetic(cursor):
        return cursor.type.get_canonical().kind in ARITHMETIC

    def swapped(self, start, end, at, old, new):
        return self.text[start:at] + new + self.text[at + len(old):end]

    # --- operators ---

    def binary(self, cursor):
        operands = list(cursor.get_children())
        if len(operands) != 2:
            return
        token, at = self.operator_between(*operands)
        start, end = self.span(cursor)
        for swaps, name in ((ARITHMETIC_SWAPS, "arithmetic"), (ASSIGNMENT_SWAPS, "arithmetic"),
                            (RELATION_SWAPS, "relation"), (LOGIC_SWAPS, "logic")):
            if token not in swaps:
                continue
            if name == "arithmetic" and not all(self.arithmetic(o) for o in operands):
                return  # pointers, dependent types
            new = swaps[token]
            changed = self.swapped(start, end, at, token, new)
            if name == "logic":  # the other one binds otherwise
                changed = f"({self.text[start:at].rstrip()}) {new} ({self.text[at + 2:end].lstrip()})"
            self.propose(start, end, "expression", changed, name, f"`{token}` to `{new}`")

    def unary(self, cursor, above):
        start, end = self.span(cursor)
        text = self.text[start:end]
        if text.startswith("-") and not text.startswith("--") and self.arithmetic(cursor):
            self.propose(start, end, "expression", text[1:], "sign", "minus dropped")
        elif text.startswith("!") and not text.startswith("!="):  # which C++20 makes of ==
            self.propose(start, end, "expression", f"static_cast<bool>({text[1:]})", "condition", "`!` dropped")
        elif text[:2] in ("++", "--") and not any(a.kind == Kind.FOR_STMT and self.in_head(cursor, a)
                                                  for a in above[-1:]):
            new = "--" if text[:2] == "++" else "++"
            self.propose(start, end, "expression", new + text[2:], "arithmetic", f"`{text[:2]}` to `{new}`")

    def in_head(self, cursor, loop):
        opening = self.text.index("(", loop.extent.start.offset)
        return cursor.extent.start.offset < matching(self.text, opening, "(", ")")

    def literal(self, cursor, above):
        start, end = self.span(cursor)
        number = NUMBER.match(self.text[start:end])
        before = self.text[:start].rstrip()[-1:]
        if not number or (before == "[" and above[-1].kind in (Kind.VAR_DECL, Kind.FIELD_DECL)):
            return
        digits, suffix = number.groups()
        if cursor.kind == Kind.INTEGER_LITERAL:
            value = int(digits)
            for new in (value + 1, value - 1):
                if new >= 0:
                    self.propose(start, end, "expression", f"{new}{suffix}", "integer", f"`{digits}` to `{new}`")
        elif float(digits) == 0.0:
            self.propose(start, end, "expression", "1.0", "number", f"`{digits}` to `1.0`")
        else:
            self.propose(start, end, "expression", f"2 * {digits}", "number", f"`{digits}` doubled")
            if before != "-":
                self.propose(start, end, "expression", f"-{digits}", "sign", f"`{digits}` to `-{digits}`")

    def boolean(self, cursor):
        start, end = self.span(cursor)
        old = self.text[start:end]
        new = {"true": "false", "false": "true"}.get(old)
        if new:
            self.propose(start, end, "expression", new, "constant", f"`{old}` to `{new}`")

    def condition(self, cursor, head):
        children = list(cursor.get_children())
        start, end = self.span(children[0])
        if not self.text.startswith(head, cursor.extent.start.offset):
            return  # if constexpr
        if start != cursor.extent.start.offset + len(head) or not children[0].kind.is_expression():
            return  # declares a variable
        if children[0].kind == Kind.UNARY_OPERATOR or re.search(r"[!=]=", self.text[start:end]):
            return  # the change of its operator says the same
        self.propose(start, end, "negation", f"!({self.text[start:end]})", "condition", "negated")

    def returned(self, cursor, function):
        children = list(cursor.get_children())
        if function is None or not children or function.result_type.get_canonical().kind not in ARITHMETIC:
            return
        value = self.source(children[0])
        if self.arithmetic(children[0]) and not NUMBER.match(value.lstrip("-")):
            start, end = self.span(children[0])
            self.propose(start, end, "expression", "0", "constant", "returns `0`")

    def statement(self, cursor, parent):
        start, end = self.span(cursor)
        jump = cursor.kind in (Kind.CONTINUE_STMT, Kind.BREAK_STMT)
        if parent.kind == Kind.CASE_STMT and jump:
            return
        if not jump and not cursor.kind.is_expression() or cursor.kind == Kind.LAMBDA_EXPR:
            return
        if parent.kind != Kind.COMPOUND_STMT and cursor.extent == list(parent.get_children())[0].extent:
            return  # a condition
        semicolon = re.compile(r"\s*;").match(self.text, end)
        if not semicolon or (parent.kind == Kind.FOR_STMT and self.in_head(cursor, parent)):
            return
        text = self.text[start:end]
        if re.search(r"\.reserve\($", text.split("(", 1)[0] + "(") and not self.name.startswith("fast/"):
            return  # only saves time
        if re.match(r"(throw|SHAPEID_CONTRACT|static_cast<void>)\b", text):
            return
        self.propose(start, semicolon.end(), "deletion", "", "deletion", "deleted")

    def call(self, cursor, above, function):
        name = cursor.spelling
        operands = list(cursor.get_children())
        start, end = self.span(cursor)
        if name.startswith("operator"):
            self.overloaded(cursor, operands, name[8:], above, function)
        elif name in CALL_SWAPS and self.keeps_type(cursor, name):
            called = self.span(operands[0]) if operands else (start, start)
            uses = [m for m in re.finditer(rf"\b{name}\b", self.text[called[0]:called[1]])]
            if uses:
                at, new = called[0] + uses[-1].start(), CALL_SWAPS[name]
                self.propose(start, end, "expression", self.swapped(start, end, at, name, new), "call",
                             f"`{name}` to `{new}`")
        elif name == "abs" and self.arithmetic(cursor):
            inner = self.text[start:end]
            self.propose(start, end, "expression", inner[inner.index("("):], "call", "`abs` dropped")

    def keeps_type(self, cursor, name):
        """The call that is swapped in gives the same type: not in templates, nor of all columns at once,
        nor of std::norm."""
        if name.lower().endswith(("norm", "coeff")):
            called = list(cursor.get_children())[:1]
            return self.arithmetic(cursor) and [c.kind for c in called] == [Kind.MEMBER_REF_EXPR]
        if name in ("rows", "cols"):
            owners = [o for member in list(cursor.get_children())[:1] for o in member.get_children()]
            return any("Eigen::" in o.type.get_canonical().spelling for o in owners)
        return name not in ("front", "back") or cursor.type.kind not in (Type.INVALID, Type.DEPENDENT)

    def overloaded(self, cursor, operands, token, above, function):
        start, end = self.span(cursor)
        if token == "()" and len(operands) == 4:
            self.indices(operands)
        if len(operands) != 3 or self.text[operands[1].extent.start.offset:][:len(token)] != token:
            return
        at = operands[1].extent.start.offset
        if token in RELATION_SWAPS and cursor.type.get_canonical().kind == Type.BOOL:
            new = RELATION_SWAPS[token]
            self.propose(start, end, "expression", self.swapped(start, end, at, token, new), "relation",
                         f"`{token}` to `{new}`")
        elif token in ("+", "-", "+=", "-="):
            spelled = cursor.type.get_canonical().spelling
            if "iterator" in spelled or not ("Eigen::" in spelled or "__gmp_expr" in spelled):
                return
            new = (ARITHMETIC_SWAPS | ASSIGNMENT_SWAPS)[token]
            self.in_statement(above + [cursor], function, at, token, new)

    def indices(self, operands):
        """a(i, j) becomes a(j, i)."""
        i, j = operands[2], operands[3]
        if not all(o.type.get_canonical().kind in INTEGERS for o in (i, j)) or i == j:
            return
        first, second = self.source(i), self.source(j)
        if "Eigen" not in operands[0].type.get_canonical().spelling:
            return
        if first == second or operands[1].extent.start.offset > i.extent.start.offset:
            return
        self.propose(i.extent.start.offset, j.extent.end.offset, "pair", f"{second}|{first}", "indices",
                     "indices swapped")

    def in_statement(self, above, function, at, old, new):
        """A change of an expression's type needs the whole statement, or what is declared, twice."""
        says = f"`{old}` to `{new}` of matrices or exact numbers"
        for parent, child in zip(reversed(above[:-1]), reversed(above)):
            if child.kind == Kind.RETURN_STMT:
                if function is None or "auto" in function.result_type.spelling:
                    return
            elif child.kind == Kind.VAR_DECL:
                self.in_declaration(parent, child, at, old, new, says)
                return
            elif parent.kind not in BODIES or not child.kind.is_expression():
                continue
            start, end = self.span(child)
            semicolon = re.compile(r"\s*;").match(self.text, end)
            if semicolon and not (parent.kind == Kind.FOR_STMT and self.in_head(child, parent)):
                end = semicolon.end()
                self.propose(start, end, "statement", self.swapped(start, end, at, old, new), "matrix", says)
            return

    def in_declaration(self, statement, variable, at, old, new, says):
        initial = list(variable.get_children())[-1]
        head = self.text[variable.extent.start.offset:variable.location.offset]
        start, end = self.span(initial)
        declared = re.sub(r"\b(const|static)\b", "", head).strip()
        if (statement.kind != Kind.DECL_STMT or len(list(statement.get_children())) != 1 or "auto" in declared
                or "&" in declared or "static" in head or not self.text[:start].rstrip().endswith("=")):
            return
        changed = f"{declared}|{self.swapped(start, end, at, old, new)}"
        self.propose(start, end, "initial", changed, "matrix", says)


def arguments(entry):
    """What libclang needs of a compilation command."""
    words = entry["command"].split()
    kept = []
    for i, word in enumerate(words):
        if word.startswith(("-I", "-D", "-std")):
            kept.append(word)
        elif word == "-isystem":
            kept += [word, words[i + 1]]
    return kept


def places(file, name, args):
    """Every place of one source, which `args` compile."""
    with open(file, encoding="ascii") as source:
        text = source.read()
    unit = cindex.Index.create().parse(file, args=args)
    errors = [str(d) for d in unit.diagnostics if d.severity >= cindex.Diagnostic.Error]
    if errors:
        raise RuntimeError(f"{name}: {errors[0]}")
    return Finder(file, name, text, unit).places()
