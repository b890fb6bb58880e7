"""What object files define, need from outside, and hold as data."""

import re
import subprocess

# A compiler may call these on its own.
FROM_THE_COMPILER = {"memcpy", "memset", "memmove", "memcmp", "__stack_chk_fail", "_GLOBAL_OFFSET_TABLE_"}
HEAP = {"malloc", "calloc", "realloc", "reallocarray", "free", "aligned_alloc", "posix_memalign", "memalign",
        "valloc", "strdup", "strndup", "asprintf", "vasprintf", "getline", "getdelim", "open_memstream"}
# Written once by the loader, then read-only.
CONSTANT_SECTIONS = re.compile(r"^\.(rodata|data\.rel\.ro|text)")


def run(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


def symbols(files, *options):
    """(file, type, name) of each symbol that nm shows."""
    found = []
    for line in run("nm", "-A", "-P", *options, *files).splitlines():
        file, name, kind = line.rsplit(":", 1)[0], *line.rsplit(": ", 1)[1].split()[:2]
        found.append((file, kind, name))
    return found


def defined(files):
    """Names that these object files show to others."""
    return {name for _, _, name in symbols(files, "-g", "--defined-only")}


def wanted(files):
    """(name, file) of what these object files need from outside."""
    own = defined(files)
    return {(name, file) for file, _, name in symbols(files, "-u") if name not in own}


def strangers(files, allowed):
    """(name, file) of what they need beside the names allowed."""
    return {(name, file) for name, file in wanted(files) if name not in allowed}


def asked_for(files, forbidden):
    """(name, file) of what they need and must not."""
    return {(name, file) for name, file in wanted(files) if name in forbidden}


def mutable(files):
    """(name, section, file) of each object that a program could write to: nm's B, D, b, d, C and the like."""
    found = []
    file = ""
    for line in run("objdump", "-t", *files).splitlines():
        if ":     file format" in line:
            file = line.split(":")[0]
        match = re.match(r"^[0-9a-f]+ (.{7}) (\S+)\s+([0-9a-f]+) (?:\.hidden )?(\S+)$", line)
        if match and ("O" in match[1] or match[2] == "*COM*") and not CONSTANT_SECTIONS.match(match[2]):
            found.append((match[4], match[2], file))
    return found
