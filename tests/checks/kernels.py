"""Reads kernels out of object files: the instructions of each, by the name that src/systems/kernels.h gives them."""

import re
import subprocess

# One arithmetic operation on one lane for each: x86's scalar and packed forms, with and without AVX.
ARITHMETIC = re.compile(r"^v?(add|sub|mul|div|sqrt|min|max)(sd|ss|pd|ps)$")


def functions(file):
    """List of (mnemonic, operands) of each function, by name. One that only jumps to another is that other."""
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
        body = found[name] = [each for each in body if not each[0].startswith(("nop", "data16", "cs", "xchg", "endbr"))]
        jump = re.search(r"<(\w+)>$", body[0][1]) if len(body) == 1 and body[0][0] == "jmp" else None
        if jump and jump[1] in found:
            found[name] = found[jump[1]]
    return found


def arithmetic(body):
    """Floating-point operations in a function's text; a packed one counts as one, however many lanes are of use."""
    return sum(1 for mnemonic, _ in body if ARITHMETIC.match(mnemonic))


def shape(body):
    """The instructions without addresses, for comparing two builds of the same arithmetic."""
    return [mnemonic for mnemonic, _ in body]
