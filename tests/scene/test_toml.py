"""The TOML reader held against Python's tomllib, and its numbers against float().

What the reader accepts, tomllib accepts with the same meaning, bit for bit; what tomllib refuses, the reader
refuses; what tomllib accepts and the reader does not is outside of the subset, and the reader says so.
"""

import fractions
import json
import os
import pathlib
import random
import shlex
import shutil
import struct
import subprocess
import tomllib

import pytest

SEED = 20240229
OUTSIDE = "outside of the subset"
NO_TABLE = "belongs to no table"
BEYOND = "beyond 64 bits"  # TOML asks for 64 bits and an error beyond; Python's integers have no end


@pytest.fixture(scope="session")
def dump(source, tmp_path_factory):
    """dump(documents) gives what the reader makes of each, as toml_dump.c prints it."""
    compiler = shlex.split(os.environ.get("CC", "cc"))
    if shutil.which(compiler[0]) is None:
        pytest.skip("no C compiler")
    place = tmp_path_factory.mktemp("toml")
    (place / "mctau").mkdir()
    (place / "mctau" / "config.h").write_text("#define MCT_REAL_IS_FLOAT 0\n")
    program = place / "toml_dump"
    scene = source / "src" / "scene"
    sources = [pathlib.Path(__file__).parent / "toml_dump.c"]
    sources += [scene / name for name in ("toml.c", "number.c", "message.c")]
    includes = [f"-I{folder}" for folder in (source / "include", source / "src", place)]
    flags = ["-std=c99", "-O2", "-ffp-contract=off"]
    subprocess.run([*compiler, *flags, *includes, *sources, "-o", program], check=True)

    def run(documents):
        feed = b"".join(b"%d\n%s" % (len(document), document) for document in documents)
        result = subprocess.run([program], input=feed, capture_output=True, check=True, timeout=60)
        answers = [json.loads(line) for line in result.stdout.splitlines()]
        assert len(answers) == len(documents)
        for answer in answers:
            answer["message"] = bytes.fromhex(answer["message"]).decode()
        return answers

    return run


def bits(value):
    return struct.pack(">d", value).hex()


def same_number(mine, value):
    """NaNs have many bits and one meaning."""
    return struct.unpack(">d", bytes.fromhex(mine))[0] != value if value != value else mine == bits(value)


def same(kind, mine, value):
    if kind == "boolean":
        return isinstance(value, bool) and mine == value
    if kind == "integer":
        return type(value) is int and mine == value
    if kind == "real":
        return isinstance(value, float) and same_number(mine, value)
    if kind == "text":
        return isinstance(value, str) and bytes.fromhex(mine) == value.encode()
    return type(value) is list and len(mine) == len(value) and all(same(*m, v) for m, v in zip(mine, value))


def check(document, answer):
    """Returns "accepted", "refused" or "outside"; fails when reader and tomllib contradict each other."""
    try:
        # TOML 1.0 says nothing about a byte order mark; the reader skips it, tomllib leaves that to its caller.
        meaning = tomllib.loads(document.decode("utf-8").removeprefix("\ufeff"))
    except (ValueError, RecursionError):
        meaning = None
    if answer["status"] != 0:
        if meaning is None:
            return "refused"
        assert any(reason in answer["message"] for reason in (OUTSIDE, NO_TABLE, BEYOND)), (document, answer)
        return "outside"
    assert meaning is not None, (document, answer)
    found = {table: {} for table in answer["tables"]}
    for table, key, kind, value in answer["entries"]:
        found[table][key] = (kind, value)
    assert found.keys() == meaning.keys(), document
    for table, keys in found.items():
        assert keys.keys() == meaning[table].keys(), document
        for key, (kind, value) in keys.items():
            assert same(kind, value, meaning[table][key]), (document, table, key, kind, value)
    return "accepted"


VALID = [
    b"", b"\n", b"\r\n", b"# a comment", b"\xef\xbb\xbf[a]\nb = 1", b"[a]", b"[ a ]\t# c\n", b"[a]\nb=1",
    b"[a]\r\nb = 1\r\n", b"a.b = 1\na.c = 2\n[d]\n", b"a . b = 1", b"[a]\nb = true\nc = false",
    b"[1]\n2 = 3\n-_ = 4", b"[a]\nb = 'x' # c", b"[a]\nb = \"\\b\\t\\n\\f\\r\\\"\\\\\\u00E9\\U0001F600\"",
    b"[a]\nb = ''\nc = \"\"", b"[a]\nb = '\"\\'", b"[a]\nb = \"'#\"", b"[a]\nb = '\tx'",
    "[a]\nb = '\u00e9\U0001f600' # \u00e9".encode(), b"[a]\nb = []", b"[a]\nb = [ ]", b"[a]\nb = [1]",
    b"[a]\nb = [1,]", b"[a]\nb = [\n1, # x\n\r\n 2.5\n,\n]\nc=1",
    b"[a]\nb = [-0, -0.0, +1, 0x1F, nan, -inf]", b"[a]\nb = 0\nc = -0\nd = +0\ne = -0.0\nf = 0e0",
    b"[a]\nb = 1_000\nc = 0xdead_beef\nd = 0o17\ne = 0b1_0\nf = 1_0.0_1e1_0",
    b"[a]\nb = ['c', \"d,]\", true]", b"[a]\nb = [[1], []]", b"[a]\nb = [['x', 1.5], # c\n [2,],\n]",
    b"[a]\nb = inf\nc = +inf\nd = -inf\ne = nan\nf = -nan",
    b"[a]\nb = 9223372036854775807\nc = -9223372036854775808",
    b"[a]\nb = 1e400\nc = 1e-400\nd = 4.9e-324\ne = 1E+05", b"[a]\nb = \"\\u0000\"", b"[a]\nb = 1#c",
]
OUTSIDE_THE_SUBSET = [
    b"a = 1", b"[a.b]", b"[[a]]", b"['a']", b"[\"a\"]", b"[a]\n'b' = 1", b"[a]\n\"b\" = 1", b"[a]\nb.c = 1",
    b"a.b.c = 1", b"[a]\nb = 1979-05-27", b"[a]\nb = 1979-05-27T07:32:00Z", b"[a]\nb = 1979-05-27 07:32:00",
    b"[a]\nb = 07:32:00", b"[a]\nb = {}", b"[a]\nb = {c = 1}", b"[a]\nb = \"\"\"c\"\"\"",
    b"[a]\nb = '''c\nd'''", b"[a]\nb = [[[1]]]", b"[a]\nb = [{}]",
    b"[a]\nb = [1979-05-27]", b"[a]\nb = 9223372036854775808", b"[a]\nb = 0xFFFFFFFFFFFFFFFF",
]
INVALID = [
    b"[a", b"[a]]", b"[]", b"[a]b", b"[a] [b]", b"[a\n]", b"[a]\n[a]", b"a.b = 1\n[a]", b"a.b = 1\na.b = 2",
    b"[a]\nb", b"[a]\nb =", b"[a]\nb = \n", b"[a]\n= 1", b"[a]\nb 1", b"[a]\nb = 1 2", b"[a]\nb = 1\nb = 2",
    b"[a]\nb = 1 c = 2", b"[a]\nb = True", b"[a]\nb = truex", b"[a]\nb = yes", b"[a]\nb = c",
    b"[a]\nb = 01", b"[a]\nb = 1.", b"[a]\nb = .5", b"[a]\nb = 1e", b"[a]\nb = 1__0", b"[a]\nb = _1",
    b"[a]\nb = 1_", b"[a]\nb = 1_.0", b"[a]\nb = +0x1", b"[a]\nb = 0X1", b"[a]\nb = 0b2", b"[a]\nb = Inf",
    b"[a]\nb = 1.2.3", b"[a]\nb = \"", b"[a]\nb = '", b"[a]\nb = \"c\nd\"", b"[a]\nb = \"\\q\"",
    b"[a]\nb = \"\\u12\"", b"[a]\nb = \"\\uD800\"", b"[a]\nb = \"\\U00110000\"", b"[a]\nb = \"\\x41\"",
    b"[a]\nb = 'c'd'", b"[a]\nb = \"c\" \"d\"", b"[a]\nb = [", b"[a]\nb = [1", b"[a]\nb = [,]",
    b"[a]\nb = [1,,2]", b"[a]\nb = [1 2]", b"[a]\nb = ]", b"[a]\nb = 1 ]", b"[a]\nb = 1, 2",
    b"[a]\nb = \x00", b"[a]\n# \x01", b"[a]\n# \x7f", b"[a]\nb = '\x1f'", b"[a]\rb = 1", b"[a]\nb = 1\r",
    b"[a]\nb = '\xff'", b"[a]\n# \xc0\x80", b"[a]\n# \xed\xa0\x80", b"[a]\n# \xf4\x90\x80\x80",
    b"\xef\xbb\xbf\xef\xbb\xbf", b"\xef\xbb", "[\u00e9]".encode(), "[a]\n\u00e9 = 1".encode(),
    b"[a]\nb\n= 1", b"[a]\nb. = 1", b".b = 1", b"a..b = 1", b"[a]\n\x0cb = 1", b"[a]\nb = 1;",
]


def test_a_document_of_the_subset_means_what_tomllib_says(dump):
    for document, answer in zip(VALID, dump(VALID)):
        assert check(document, answer) == "accepted", (document, answer)


def test_what_toml_has_and_the_subset_has_not_is_refused_with_these_words(dump):
    for document, answer in zip(OUTSIDE_THE_SUBSET, dump(OUTSIDE_THE_SUBSET)):
        assert check(document, answer) == "outside", (document, answer)


def test_what_toml_forbids_is_refused(dump):
    for document, answer in zip(INVALID, dump(INVALID)):
        assert check(document, answer) == "refused", (document, answer)


# Pieces of texts, and what a mutation puts where it does not belong.
BASIC = ["a", " ", "#", "'", "\\n", "\\\"", "\\\\", "\\u20AC", "\\U0001F600", "\u20ac", "\t"]
LITERAL = ["a", "\\", '"', "#", "\u00e9", "="]
INJURIES = [b"[", b"]", b"=", b"\"", b"'", b",", b"\n", b"\r", b"#", b".", b"\\", b"_", b"0", b"-", b"e", b" ",
            b"{", b"\x00", b"\xff", b"\xc3", b"1979-05-27", b"\"\"\"", b"[[", b"inf", b"0x"]


def random_number(pick):
    digits = "".join(pick.choice("0123456789") for _ in range(pick.randint(1, 30)))
    kind = pick.randrange(8)
    if kind == 0:
        return str(pick.randint(-2**63, 2**63 - 1))
    if kind == 1:
        return pick.choice([hex, oct, bin])(pick.getrandbits(60))
    if kind == 2:
        return pick.choice(["inf", "-inf", "nan", "0", "-0", "1_000", "1_0.5e-1_0"])
    exponent = pick.choice(["", f"e{pick.randint(-330, 320)}"])
    return f"{pick.choice(['', '-', '+'])}{int(digits)}.{digits}{exponent}"


def random_document(pick):
    newline = pick.choice(["\n", "\r\n"])
    blank = lambda: pick.choice(["", " ", "\t", "  "])
    end = lambda: blank() + pick.choice(["", "# \u00e9 [x] = \"", "#"]) + newline
    text = pick.choice(["", "", "\ufeff"])
    for table in pick.sample(["a", "b-1", "scene", "input_2", "7"], pick.randint(1, 4)):
        text += end() * pick.randrange(3) + f"{blank()}[{blank()}{table}{blank()}]{end()}"
        for key in pick.sample(["x", "y_1", "-z", "42", "dt", "values"], pick.randrange(5)):
            kind = pick.randrange(5)
            if kind == 0:
                value = pick.choice(["true", "false"])
            elif kind == 1:
                value = '"' + "".join(pick.choices(BASIC, k=pick.randrange(12))) + '"'
            elif kind == 2:
                value = "'" + "".join(pick.choices(LITERAL, k=pick.randrange(8))) + "'"
            elif kind == 3:
                gap = lambda: pick.choice(["", " ", newline, " # c" + newline])

                def listing(make):
                    items = [gap() + make() + gap() for _ in range(pick.randrange(6))]
                    return "[" + ",".join(items) + ("," if items and pick.random() < 0.3 else "") + gap() + "]"

                item = lambda: random_number(pick) if pick.random() < 0.8 else pick.choice(["'a,'", "true", '"]"'])
                value = listing(item) if pick.random() < 0.6 else listing(lambda: listing(item))
            else:
                value = random_number(pick)
            text += f"{blank()}{key}{blank()}={blank()}{value}{end()}"
    return text.encode()


def mutate(pick, document):
    """One to four small injuries, so that most of the document stays what it was."""
    data = bytearray(document)
    for _ in range(pick.choice([1, 1, 2, 4])):
        place = pick.randrange(len(data) + 1)
        kind = pick.randrange(4)
        if kind == 0:
            data[place:place] = pick.choice(INJURIES)
        elif kind == 1:
            del data[place:place + pick.randint(1, 6)]
        elif kind == 2 and place < len(data):
            data[place] = pick.randrange(256)
        else:
            other = pick.randrange(len(data) + 1)
            data[place:place] = data[other:other + pick.randint(1, 20)]
    return bytes(data)


def test_generated_documents_mean_what_tomllib_says(dump):
    pick = random.Random(SEED)
    documents = [random_document(pick) for _ in range(2000)]
    for document, answer in zip(documents, dump(documents)):
        assert check(document, answer) == "accepted", (document, answer)


def test_injured_documents_never_mean_something_else(dump):
    pick = random.Random(SEED + 1)
    bases = VALID + OUTSIDE_THE_SUBSET + INVALID
    documents = [mutate(pick, pick.choice(bases) if i % 2 else random_document(pick)) for i in range(6000)]
    verdicts = [check(document, answer) for document, answer in zip(documents, dump(documents))]
    for verdict, least in (("accepted", 300), ("refused", 300), ("outside", 30)):
        assert verdicts.count(verdict) > least, verdict  # or the generator proves nothing


def decimal_of(value):
    """All digits of a fraction whose denominator is a power of two."""
    twos = value.denominator.bit_length() - 1
    return f"{value.numerator * 5**twos}e-{twos}" if twos else f"{value.numerator}e0"


def random_double(pick):
    pattern = pick.choice([pick.getrandbits(52), pick.getrandbits(pick.randint(1, 52)), pick.randrange(0x7FF << 52),
                           (pick.randrange(0x7FF) << 52) + pick.choice([0, 1, 2**52 - 1])])
    return struct.unpack(">d", struct.pack(">Q", pattern))[0], pattern


def random_decimal(pick, kind):
    if kind == 0:  # the middle of two doubles, or a hair beside it
        lower, pattern = random_double(pick)
        upper = (fractions.Fraction(2)**1024 if pattern == (0x7FF << 52) - 1
                 else fractions.Fraction(struct.unpack(">d", struct.pack(">Q", pattern + 1))[0]))
        digits, exponent = decimal_of((fractions.Fraction(lower) + upper) / 2).split("e")
        extra = pick.choice(["", "0" * pick.randint(1, 900) + "1", "-"])
        if extra == "-":
            digits, extra = str(int(digits) - 1), "9" * pick.randint(1, 900)
        return f"{digits}.{extra or '0'}e{exponent}"
    if kind == 1:
        return repr(random_double(pick)[0])
    if kind == 2:
        return "%.16e" % random_double(pick)[0]
    if kind == 3:  # 17 to 40 digits
        return f"{pick.randrange(10**16, 10**pick.randint(17, 40))}e{pick.randint(-370, 290)}"
    if kind == 4:
        digits = pick.getrandbits(pick.randint(1, 300))
        return f"0.{'0' * pick.randint(0, 330)}{digits}e{pick.randint(-30, 330)}"
    if kind == 5:
        reach = pick.choice([400, 10**12])
        return f"{pick.getrandbits(64)}e{pick.randint(-reach, reach)}"
    return f"{pick.randrange(10**pick.randint(1, 15))}.{pick.randrange(10**6)}"  # as people write


def test_numbers_have_the_bits_that_python_gives_them(dump):
    pick = random.Random(SEED + 2)
    numbers = [random_decimal(pick, i % 7) for i in range(35_000)]
    numbers = [number if "." in number or "e" in number else number + ".0" for number in numbers]
    lists = [",".join(numbers[i:i + 100]) for i in range(0, len(numbers), 100)]
    documents = [f"[a]\nb = [{numbers}]".encode() for numbers in lists]
    read = [value for answer in dump(documents) for _, value in answer["entries"][0][3]]
    assert len(read) == len(numbers)
    wrong = [(number, mine) for number, mine in zip(numbers, read) if mine != bits(float(number))]
    assert not wrong, wrong[:3]
