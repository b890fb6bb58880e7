"""Reads kernels out of object files: the instructions of each, by the name from src/systems/kernels.h."""

import collections
import dataclasses
import json
import re
import shlex
import shutil
import subprocess
import sys

import pytest

# x86's scalar and packed forms, with and without AVX.
PADDING = ("nop", "data16", "cs", "xchg", "endbr")
# What puts a number elsewhere, a register that is set to 0, and jumps from one piece of a path to its next: how many of
# these a text has is up to the places that a compiler finds for its values and its blocks.
MOVES = re.compile(r"^(v?mov|push|pop|c(wt|lt|qt)\b|jmp|nop|data16|cs\b|xchg|endbr)")
ZERO = re.compile(r"^v?p?xor(l|p[sd])?\s+(%\w+),\2$")
ARITHMETIC = re.compile(r"^v?(add|sub|mul|div|sqrt|min|max)(sd|ss|pd|ps)$")


def compile_command(build, source, tag):
    """How a file of src/ was compiled, as a list of words."""
    for entry in json.loads((build / "compile_commands.json").read_text()):
        if entry["file"].endswith(source) and f"mctau_core_{tag}.dir" in entry["command"]:
            return shlex.split(entry["command"])
    raise AssertionError(f"no compile command of {source}, {tag}")


def object_file(build, source, tag):
    command = compile_command(build, source, tag)
    return build / command[command.index("-o") + 1]


def functions(file):
    """List of (mnemonic, operands) of each function, by name. One that only jumps is where it jumps to."""
    table = subprocess.run(["objdump", "-d", "--no-show-raw-insn", file], capture_output=True, text=True,
                           check=True).stdout
    found, name = {}, None
    for line in table.splitlines():
        header = re.match(r"^[0-9a-f]+ <(\S+)>:$", line)
        if header:
            name = header[1]
            found[name] = []
            continue
        instruction = re.match(r"^\s+[0-9a-f]+:\s+(\S+)\s*(.*?)\s*(#.*)?$", line)
        if name and instruction:
            found[name].append((instruction[1], instruction[2]))
    for name, body in found.items():
        body = found[name] = [each for each in body if not each[0].startswith(PADDING)]
        jump = re.search(r"<(\w+)>$", body[0][1]) if len(body) == 1 and body[0][0] == "jmp" else None
        if jump and jump[1] in found:
            found[name] = found[jump[1]]
    return found


@dataclasses.dataclass(frozen=True)
class Executed:
    """Instructions of a step as it runs."""

    all: float
    work: float  # without moves


def executed(source, program):
    """Instructions of each piece of work that a program of measure.h counts, by the piece's name."""
    if shutil.which("valgrind") is None:
        pytest.skip("valgrind, which counts instructions, is not installed; run tools/setup")
    sys.path.insert(0, str(source / "tools" / "benchmark"))
    import instructions

    moves = moves_at(program)
    return {name: Executed(sum(counts.values()), sum(count for at, count in counts.items() if at not in moves))
            for name, counts in instructions.count_each(program).items()}


def moves_at(program):
    """Addresses of a program's moves."""
    table = subprocess.run(["objdump", "-d", "--no-show-raw-insn", program], capture_output=True, text=True,
                           check=True).stdout
    lines = re.findall(r"^\s+([0-9a-f]+):\s+(.*?)\s*(?:[#<].*)?$", table, re.MULTILINE)
    return {int(address, 16) for address, text in lines if MOVES.match(text) or ZERO.match(text)}


def arithmetic(body):
    """Floating-point operations in a function's text; a packed one counts as one."""
    return sum(1 for mnemonic, _ in body if ARITHMETIC.match(mnemonic))


def called(body):
    """Names of the functions that a function calls, or goes on as, by call."""
    targets = (re.search(r"<([^+>]+)>$", operands) for mnemonic, operands in body if mnemonic in ("call", "jmp"))
    return [target[1] for target in targets if target]


def operations(functions, name):
    """How often each floating-point operation stands in a function's text, and in that of what it calls, by call."""
    count = collections.Counter(mnemonic for mnemonic, _ in functions[name] if ARITHMETIC.match(mnemonic))
    for other in called(functions[name]):
        if other in functions and other != name:
            count += operations(functions, other)
    return count
