"""Reads kernels out of object files: the instructions of each, by the name from src/systems/kernels.h."""

import collections
import json
import re
import shlex
import subprocess

# x86's scalar and packed forms, with and without AVX.
PADDING = ("nop", "data16", "cs", "xchg", "endbr")
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
