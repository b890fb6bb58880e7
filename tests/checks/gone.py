"""Kernels compiled from texts from which the effects that they lack were deleted, to be held against the library's."""

import concurrent.futures
import dataclasses
import hashlib
import os
import re
import shlex
import subprocess

from checks import deletion, kernels, symbols

# Of a deleted text those kernels alone are made that have exactly the other effects.
ONLY = """
#define mct_advance(increments, friction, constants, remainder, effects, ...) \\
    if (((effects) & {all}u) == {mask}u) \\
        (mct_advance)(increments, friction, constants, remainder, effects, __VA_ARGS__)
"""
DEFINITION = re.compile(r"\bvoid mct_advance \( mct_derivative increments , mct_derivative friction , "
                        r"const void \* constants , mct_real remainder , unsigned effects ,")


@dataclasses.dataclass(frozen=True)
class Kernel:
    """One of the library's: found by asking mct_system.kernel()."""

    system: str
    stepper: str
    effects: int
    file: str  # of its source
    symbol: str

    def __str__(self):
        return f"{self.system}_{self.stepper}_{self.effects:x}"


def printed(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()


def kernels_program(build, source, folder):
    """A program that prints all kernels of the library in double precision, with their addresses in it."""
    program = folder / "kernels"
    parts = [source / "tools/cortex_m" / name for name in ("kernels.c", "native.c")]
    includes = [f"-I{place}" for place in (build / "include/double", source / "include", source)]
    compiler = shlex.split(os.environ.get("CC", "cc"))
    subprocess.run([*compiler, "-no-pie", *includes, *parts, build / "libmctau.a", "-o", program], check=True)
    return program


def all_kernels(build, source, folder):
    """Every kernel of the library in double precision."""
    members = symbols.symbols([build / "libmctau.a"], "-g", "--defined-only")
    files = {name: re.search(r"\[(.+)\.o\]$", member)[1] for member, _, name in members}
    found = []
    for line in printed(kernels_program(build, source, folder)):
        system, stepper, effects, _, symbol = line.split()
        found.append(Kernel(system, stepper, int(effects, 16), files[symbol], symbol))
    return found


def compiled(build, folder, file, texts, masks, mask, deletes=True):
    """Object file of the kernels with the effects of `mask`, from texts without all others, or from all of them."""
    all_effects = sum(masks[name] for name in deletion.bits(masks)) & ~masks["MCT_SATURATION"]
    deleter = deletion.Deleter(masks, all_effects & ~mask if deletes else 0)
    new = deleter.files(texts)
    advance = "src/steppers/advance.h"
    new[advance], count = DEFINITION.subn(lambda found: found[0].replace("mct_advance", "(mct_advance)"), new[advance])
    assert count == 1, f"mct_advance has other arguments than {DEFINITION.pattern}"
    new[advance] += ONLY.format(all=all_effects, mask=mask)
    new[file] = deleter.readers() + new[file]
    command = [word for word in kernels.compile_command(build, file, "f64") if not word.startswith(("-W", "-g"))]
    key = hashlib.sha256("\0".join([*command, *(part for item in sorted(new.items()) for part in item)]).encode())
    made = build / "check" / "deleted" / f"{key.hexdigest()[:32]}.o"
    if not made.exists():
        place = folder / f"{file.replace('/', '_')}_{mask:x}_{key.hexdigest()[:8]}"
        for name, text in new.items():
            (place / name).parent.mkdir(parents=True, exist_ok=True)
            (place / name).write_text(text)
        command[command.index("-o") + 1] = str(place / "made.o")
        command[command.index("-c") + 1] = str(place / file)
        subprocess.run([*command, "-w"], check=True, cwd=build)
        made.parent.mkdir(parents=True, exist_ok=True)
        os.replace(place / "made.o", made)
    return made


def compile_all(build, source, folder, wanted):
    """Object files by (file, mask), of all kernels wanted."""
    texts = {file: deletion.read(source, f"src/systems/{file}") for file in {one.file for one in wanted}}
    masks = {file: deletion.masks(source, each) for file, each in texts.items()}

    def make(pair):
        file, mask = pair
        return pair, compiled(build, folder, f"src/systems/{file}", texts[file], masks[file], mask)

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count() or 1) as pool:
        return dict(pool.map(make, sorted({(one.file, one.effects) for one in wanted})))
