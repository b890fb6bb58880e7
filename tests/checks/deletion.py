"""Deletes effects from the C text of the kernels: what a source would be in which they had never been written.

Of every test `effects & MASK` the effects' bits are taken out. One that has none left is false: blocks and branches that
it held are removed from the text, and so are operands, arms of ?:, `const bool` names for it, and calls of functions that
do nothing but return it. Nothing is left to a compiler, which is to be judged. Texts are lists of tokens; directives are
one token each and stay.
"""

import functools
import pathlib
import re

TOKEN = re.compile(
    r"""(?P<space>\s+|/\*.*?\*/|//[^\n]*)
      | (?P<directive>(?<![^\n])[ \t]*\#(?:\\\n|/\*.*?\*/|[^\n])*)
      | "(?:\\.|[^"\\])*" | '(?:\\.|[^'\\])*'
      | \.?[0-9](?:[eEpP][+-]|[\w.])* | [A-Za-z_]\w*
      | ->|<<=|>>=|\.\.\.|[-+*/%&|^=!<>]=|\+\+|--|<<|>>|&&|\|\||\#\#|.""",
    re.VERBOSE | re.DOTALL)
OPENING, CLOSING = {"(": ")", "[": "]", "{": "}"}, {")", "]", "}"}
ASSIGNMENTS = {"=", "+=", "-=", "*=", "/=", "|=", "&="}
FALSE, TRUE = ["0"], ["1"]
AS_GIVEN, READ = "_as_given", "read_"
LISTED = re.compile(r"^\s+(MCT_\w+) =\s+1 << (\d+)", re.MULTILINE)
DEFINED = re.compile(r"^#define (\w+)[ ]+([A-Z(][^\n]*?)\s*(?:/\*.*)?$", re.MULTILINE)


class NotUnderstood(Exception):
    """C that the rules here do not cover."""


@functools.cache
def tokens_of(text):
    found = []
    for match in TOKEN.finditer(text):
        if match.lastgroup == "directive":
            found.append("\n" + match[0].strip() + "\n")
        elif match.lastgroup != "space":
            found.append(match[0])
    return found


def text_of(tokens):
    return "".join(token + ("\n" if token in ";{}" else " ") for token in tokens)


def closing(tokens, start):
    """Index of the bracket that closes the one at `start`."""
    depth = 0
    for i in range(start, len(tokens)):
        depth += (tokens[i] in OPENING) - (tokens[i] in CLOSING)
        if depth == 0:
            return i
    raise NotUnderstood(f"{tokens[start]} is not closed")


def places(tokens, wanted):
    """Indices of the tokens wanted that are in no bracket."""
    depth, found = 0, []
    for i, token in enumerate(tokens):
        depth -= token in CLOSING
        if depth == 0 and token in wanted:
            found.append(i)
        depth += token in OPENING
    return found


def parts(tokens, separator):
    """The tokens between separators that are in no bracket."""
    ends = [-1, *places(tokens, {separator}), len(tokens)]
    return [tokens[begin + 1 : end] for begin, end in zip(ends, ends[1:])]


def joined(lists, separator):
    return [token for i, each in enumerate(lists) for token in ([separator, *each] if i else each)]


def with_value(tokens, name, value):
    """A value in place of a name, but not of a member that is called so."""
    pairs = zip(["", *tokens], tokens)
    return [value if token == name and before not in (".", "->") else token for before, token in pairs]


def masks_of(*texts):
    """Values of the effects' bits, and of the names that the texts define for sets of them."""
    found = {}
    for text in texts:
        found |= {name: 1 << int(bit) for name, bit in LISTED.findall(text)}
    for text in texts:
        for name, value in DEFINED.findall(text):
            words = re.findall(r"\w+", value)
            if words and all(word in found for word in words) and re.fullmatch(r"[\w\s|()]+", value):
                found[name] = functools.reduce(lambda mask, word: mask | found[word], words, 0)
    return found


def bits(masks):
    """Names of single effects."""
    return [name for name, mask in masks.items() if mask & (mask - 1) == 0]


def opening(tokens, end):
    """Index of the bracket that the one at `end` closes."""
    depth = 0
    for i in range(end, -1, -1):
        depth += (tokens[i] in CLOSING) - (tokens[i] in OPENING)
        if depth == 0:
            return i
    raise NotUnderstood(f"{tokens[end]} is not opened")


def operand(tokens):
    """Where a->b[i].c begins, which the tokens end with."""
    i = len(tokens) - 1
    while True:
        while tokens[i] in ("]", ")"):
            i = opening(tokens, i)
            if not re.match(r"\w|[])]", tokens[i - 1]):
                return i  # a bracket around the operand
            i -= 1
        if tokens[i - 1] not in (".", "->"):
            return i
        i -= 2


def functions(tokens):
    """Name of each function that is defined, and the places of its body's braces."""
    for start in places(tokens, {"{"}):
        if start and tokens[start - 1] == ")":
            yield tokens[opening(tokens, start - 1) - 1], start, closing(tokens, start)


def with_bodies(tokens, changed):
    """With another body of each function: changed(name, tokens)."""
    out, behind = [], 0
    for name, start, end in functions(tokens):
        out += [*tokens[behind : start + 1], *changed(name, tokens[start + 1 : end])]
        behind = end
    return [*out, *tokens[behind:]]


def zeros(files):
    """Members to which nothing but 0 is ever assigned, or what is 0 itself."""
    values = {}
    for tokens in files.values():
        for i, token in enumerate(tokens):
            if token == "=":
                member = i - 1 if tokens[i - 1] != "]" else opening(tokens, i - 1) - 1
                if tokens[member - 1] in (".", "->"):
                    ends = [end for end in range(i, len(tokens)) if tokens[end] in (";", ",")]
                    values.setdefault(tokens[member], []).append(tokens[i + 1 : ends[0]])
    found, known = set(), None
    while known != len(found):
        known = len(found)
        nothing = {"(", ")", "+", "0", "mct_real", "k", "->", *found}
        found = {name for name, assigned in values.items()
                 if all("0" in each or found.intersection(each) for each in assigned)
                 and all(nothing.issuperset(each) for each in assigned)}
    return found


class Deleter:
    """Deletes effects, given as bits, from texts that name masks as `masks` says."""

    def __init__(self, masks, deleted):
        self.masks, self.deleted = masks, deleted
        self.constant = {}  # functions that return the same always
        self.zeros = set()
        self.bits = bits(masks)
        self.names = {name for name, mask in masks.items() if mask & deleted}

    # --- expressions ---

    def mask(self, tokens):
        """The value of MCT_A, or of (MCT_A | MCT_B); None of anything else."""
        words = [token for token in tokens if token not in ("(", ")", "|")]
        if not words or any(word not in self.masks for word in words):
            return None
        return functools.reduce(lambda mask, word: mask | self.masks[word], words, 0)

    def tested(self, tokens):
        """`effects & MASK` without what is deleted."""
        place = places(tokens, {"&"})
        if len(place) != 1 or tokens[place[0] - 1] != "effects":
            return None
        mask = self.mask(tokens[place[0] + 1 :])
        if mask is None or not mask & self.deleted:
            return None
        left = [name for name in self.bits if self.masks[name] & mask & ~self.deleted]
        return [*tokens[: place[0]], "&", "(", *joined([[name] for name in left], "|"), ")"] if left else FALSE

    def groups(self, tokens):
        """What is in brackets, simplified."""
        out, i = [], 0
        while i < len(tokens):
            if tokens[i] in self.constant and tokens[i + 1 : i + 2] == ["("]:
                out.append(self.constant[tokens[i]])
                i = closing(tokens, i + 1) + 1
            elif tokens[i] in OPENING:
                end = closing(tokens, i)
                out += [tokens[i], *self.expression(tokens[i + 1 : end]), tokens[end]]
                i = end + 1
            else:
                out.append(tokens[i])
                i += 1
        if len(out) == 3 and out[0] == "(" and out[1] in ("0", "1"):
            return [out[1]]
        return out

    def expression(self, tokens):
        if not tokens:
            return tokens
        if tokens[0] == "return":
            return ["return", *self.expression(tokens[1:])]
        for separator in (";", ","):
            if places(tokens, {separator}):
                return joined([self.expression(part) for part in parts(tokens, separator)], separator)
        assigned = places(tokens, ASSIGNMENTS)
        if assigned:
            value = assigned[0] + 1
            return [*self.groups(tokens[: value - 1]), tokens[value - 1], *self.expression(tokens[value:])]
        question = places(tokens, {"?"})
        if question:
            return self.conditional(tokens, question[0])
        if places(tokens, {"||"}):
            return self.operands(tokens, "||", FALSE, TRUE)
        if places(tokens, {"&&"}):
            return self.operands(tokens, "&&", TRUE, FALSE)
        if len(tokens) > 2 and tokens[-2:] == ["!=", "0"]:
            value = self.expression(tokens[:-2])
            return value if value in (FALSE, TRUE) else [*value, "!=", "0"]
        if places(tokens, {"==", "!="}):
            return tokens  # a choice among kinds, no test
        if tokens[0] == "!":
            value = self.expression(tokens[1:])
            return TRUE if value == FALSE else FALSE if value == TRUE else ["!", *value]
        test = self.tested(tokens)
        return test if test is not None else self.groups(tokens)

    def operands(self, tokens, operator, neutral, decisive):
        kept = [value for value in map(self.expression, parts(tokens, operator)) if value != neutral]
        if decisive in kept:
            return decisive
        return joined(kept, operator) if kept else neutral

    def conditional(self, tokens, question):
        """a ? b : c, of which c may be the next of them."""
        depth = 0
        for i in places(tokens, {"?", ":"}):
            depth += 1 if tokens[i] == "?" else -1
            if depth == 0:
                condition = self.expression(tokens[:question])
                arms = self.expression(tokens[question + 1 : i]), self.expression(tokens[i + 1 :])
                if condition in (FALSE, TRUE):
                    return arms[condition == FALSE]
                return [*condition, "?", *arms[0], ":", *arms[1]]
        raise NotUnderstood("? without :")

    # --- statements ---

    def end_of(self, tokens, start):
        """Index behind the statement that begins at `start`."""
        word = tokens[start]
        if word == "{":
            return closing(tokens, start) + 1
        if word in ("if", "for", "while", "switch"):
            end = self.end_of(tokens, closing(tokens, start + 1) + 1)
            return self.end_of(tokens, end + 1) if word == "if" and tokens[end : end + 1] == ["else"] else end
        if word == "do" or word.startswith("\n"):
            raise NotUnderstood(f"a statement that begins with {word.strip()}")
        return start + places(tokens[start:], {";"})[0] + 1

    def block(self, tokens):
        """The statements between two braces."""
        out, i = [], 0
        while i < len(tokens):
            if tokens[i] == "MCT_UNROLL" or tokens[i].startswith("\n"):
                out.append(tokens[i])
                i += 1
                continue
            end = self.end_of(tokens, i)
            statement = self.statement(tokens[i:end])
            if len(statement) == 6 and statement[0] == "const" and statement[4] in ("0", "1"):
                tokens = [*tokens[:end], *with_value(tokens[end - 1 :], statement[2], statement[4])[1:]]
            else:
                out += statement
            i = end
        return out

    def statement(self, tokens):
        word = tokens[0]
        if word == "{":
            return ["{", *self.block(tokens[1:-1]), "}"]
        if word not in ("if", "for", "while", "switch"):
            return [*self.expression(tokens[:-1]), ";"]
        head = closing(tokens, 1)
        condition = self.expression(tokens[2:head])
        then = self.end_of(tokens, head + 1)
        held = self.statement(tokens[head + 1 : then])
        if word == "if":
            other = self.statement(tokens[then + 1 :]) if tokens[then:] else []
            if condition in (FALSE, TRUE):
                return held if condition == TRUE else other
            held += ["else", *other] if other else []
        return [word, "(", *condition, ")", *held]

    # --- files ---

    def body(self, name, tokens):
        if name.endswith(AS_GIVEN) or not (self.names | self.constant.keys()).intersection(tokens):
            return tokens
        tokens = self.block(tokens)
        statements = parts(tokens, ";")
        if statements[-2:] in ([["return", "0"], []], [["return", "1"], []]) and all(
                each[0] == "const" for each in statements[:-2]):
            self.constant[name] = statements[-2][1]
        return tokens

    def files(self, texts):
        """Texts by their names, with the effects deleted from each."""
        files = self.with_clones({name: tokens_of(text) for name, text in texts.items()})
        always = zeros(files)
        known = None
        while known != len(self.constant):  # what is constant may make another so
            known = len(self.constant)
            files = {name: with_bodies(tokens, self.body) for name, tokens in files.items()}
        self.zeros = zeros(files) - always
        return {name: text_of(with_bodies(tokens, self.marked)) for name, tokens in files.items()}

    def with_clones(self, files):
        """
        A function that is called with a mask of the caller's own, `solve(k, MCT_GRAVITY, ...)`, is told no effects of the
        kernel: there it stays as it is, in a copy.
        """
        defined = {name for tokens in files.values() for name, _, _ in functions(tokens)}
        wanted = set()

        def with_calls(tokens, is_own):
            tokens = list(tokens)
            for i in range(len(tokens) - 1):
                if tokens[i] in defined and tokens[i + 1] == "(":
                    if any(is_own(argument) for argument in parts(tokens[i + 2 : closing(tokens, i + 1)], ",")):
                        wanted.add(tokens[i])
                        tokens[i] += AS_GIVEN
            return tokens

        files = {name: with_bodies(tokens, lambda _, body: with_calls(body, lambda one: self.mask(one) is not None))
                 for name, tokens in files.items()}
        done = set()
        while wanted - done:
            name = sorted(wanted - done)[0]
            done.add(name)
            for file, tokens in files.items():
                for own, start, end in functions(tokens):
                    if own == name:
                        head = 1 + max(i for i in range(start) if tokens[i] in ";}" or tokens[i].startswith("\n"))
                        body = with_calls(tokens[start:end], lambda argument: argument == ["effects"])
                        copy = [name + AS_GIVEN if token == name else token for token in tokens[head:start]] + body + ["}"]
                        files[file] = [*tokens[:head], *copy, *tokens[head:]]
        return files

    def marked(self, _, tokens):
        """A read of what is 0 since an effect is off goes through read_NAME(): in a kernel it would be work for nothing."""
        out = []
        for i, token in enumerate(tokens):
            out.append(token)
            if token in self.zeros and tokens[i - 1 : i] in (["."], ["->"]) and tokens[i + 1 : i + 2] != ["="]:
                start = operand(out)
                place = ["(", "&", "(", *out[start:], ")", ")"]
                out[start:] = ["(", "*", "(", "__typeof__", *place, ")", READ + token, *place, ")"]
        return out

    def readers(self):
        """Definitions of those functions, whose calls a compiler drops where nothing comes of them."""
        return "".join(f"static __attribute__((noipa, pure)) void *{READ}{name}(const void *at) {{ return (void *)at; }}\n"
                       for name in sorted(self.zeros))

    def left(self, text):
        """Functions in a text from which the effects should be gone that test them still, but for those that choose kernels."""
        found, tokens = [], tokens_of(text)
        for name, start, end in functions(tokens):
            if "kernel" not in name and not name.endswith(AS_GIVEN):
                body = tokens[start:end]
                tests = (body[i + 2 : i + 8] for i in range(len(body)) if body[i : i + 2] == ["effects", "&"])
                if any(self.names.intersection(test) for test in tests):
                    found.append(name)
        return found


ROOMS = ("src/systems/*.h", "src/steppers/*.h", "src/effects/*.h")


def read(source, file):
    """The texts that a system's file compiles, but for those that know no effects: by their paths."""
    paths = [source / file, *(path for room in ROOMS for path in sorted(source.glob(room)))]
    return {str(path.relative_to(source)): path.read_text() for path in paths}


def masks(source, texts):
    return masks_of((pathlib.Path(source) / "include/mctau/effects.h").read_text(), *texts.values())
