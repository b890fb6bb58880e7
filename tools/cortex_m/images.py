"""Images of compiled scenes: builds them for a target, runs them, and says what they take.

    with images.compiled("scenes/cart_pole.toml", "float") as scene:
        image = images.build(scene, "twin", "qemu-m4f")
        images.run(image, "qemu-m4f")["instructions"]["most"]
        images.memory(image)["flash"]
"""

import contextlib
import dataclasses
import os
import pathlib
import re
import shutil
import struct
import subprocess
import tempfile

import counts

CORES = {"qemu-m4f": "cortex-m4f", "qemu-m7": "cortex-m7"}  # target: what it is built for
STANDARD = {"qemu-m4f": "float", "qemu-m7": "double"}  # precision; else the scene's
KINDS = ("twin", "controller")
BUDGET = 168e3  # instructions of a millisecond at 168 MHz, were each of them a cycle


class TooLarge(Exception):
    """The image does not fit; the text says by how much."""


@dataclasses.dataclass
class Scene:
    """A scene as `mctau compile` has written it."""

    path: str
    assignments: list
    precision: str
    system: str
    kernel: str
    folder: pathlib.Path
    source: pathlib.Path


def is_can(target):
    return re.fullmatch(r"v?can\d+", target) is not None


def command():
    return os.environ.get("MCTAU", counts.host_build() / "mctau")


def missing(target):
    """Why nothing can be built for a target here, or None."""
    if not pathlib.Path(command()).exists():
        return f"there is no {command()}: cmake --build --preset host"
    if target in CORES:
        return counts.missing()
    return None if shutil.which("cc") else "there is no C compiler; apt-get install gcc"


def _overrides(assignments):
    return [word for assignment in assignments for word in ("--set", assignment)]


def _mctau(*arguments):
    done = subprocess.run([str(word) for word in (command(), *arguments)], capture_output=True, text=True)
    if done.returncode:
        kind = counts.BadScene if done.returncode == 2 else counts.Unavailable
        raise kind(done.stderr.strip().removeprefix("mctau: "))
    return done.stdout


@contextlib.contextmanager
def compiled(path, precision=None, assignments=()):
    """The scene as C, in a folder that lasts as long as the context."""
    with tempfile.TemporaryDirectory() as folder:
        source = pathlib.Path(folder, "scene.c")
        wanted = ["--precision", precision] if precision else []
        _mctau("compile", path, *wanted, *_overrides(assignments), "-o", source)
        text = source.read_text()
        found = dict(re.findall(r'^    \.(name) = "(\w+)"', text, re.MULTILINE))
        kernel = re.search(r"^ +\.kernel = (\w+)", text, re.MULTILINE).group(1)
        is_float = "MCT_REAL_IS_FLOAT != 1" in text
        yield Scene(str(path), list(assignments), "float" if is_float else "double", found["name"], kernel,
                    pathlib.Path(folder), source)


# --- building ---


def build(scene, kind, target):
    """Path of the program: an image for the emulator, or a process for this machine."""
    program = scene.folder / f"{kind}-{target}"
    here = counts.HERE
    files = [scene.source, here / f"{kind}.c", here / "image.c"]
    if target not in CORES:
        counts.compile_here(program, scene.precision, [*files, here / "native.c"], counts.host_build())
        return program
    tag = counts.PRECISIONS[scene.precision]
    names = [f"mctau_core_{tag}", f"mctau_{scene.system}_{tag}", "mctau_start"]
    libraries = [counts.build_target(CORES[target], name, f"lib{name}.a") for name in names]
    folder = libraries[0].parent
    includes = [f"-I{place}" for place in (folder / "include" / tag, counts.ROOT / "include", counts.ROOT)]
    group = ["-Wl,--start-group", *libraries, "-Wl,--end-group"]
    no_clock = ["-Wl,--defsym=mct_clock_start=0,--defsym=mct_clock_wait=0"]  # a clock is for real time alone
    try:
        counts.output(["arm-none-eabi-gcc", f"@{folder}/image.options", *includes, *files, *group, *no_clock, "-o", program])
    except counts.Failed as why:
        short = re.findall(r"region `(\w+)' overflowed by (\d+) bytes|(less than .* is left for the stack)", why.said)
        if not short:
            raise
        told = [f"{region} by {over} bytes" if region else other for region, over, other in short]
        raise TooLarge(f"{scene.path} is too large for {target}: {', '.join(told)}") from why
    return program


# --- running ---


def run(program, target, *arguments, stop_after=counts.RUN_SECONDS):
    """What the program says of its run: ticks, hash, mode, faults; counts where the target counts."""
    words = [str(word) for word in arguments]
    if target in CORES:
        line = [counts.ROOT / "hal/cortex_m/run", counts.TARGETS[CORES[target]], program, *words]
        done = subprocess.run(line, capture_output=True, text=True, timeout=stop_after)
    else:
        environment = os.environ | {"IMAGE_ARGUMENTS": " ".join(words)}
        done = subprocess.run([program], capture_output=True, text=True, timeout=stop_after, env=environment)
    lines = [line.partition(" ") for line in done.stdout.splitlines()]
    said = {name: rest for name, _, rest in lines}
    if "run" not in said:
        raise counts.Unavailable(said.get("failed:", (done.stdout + done.stderr).strip() or "the image said nothing"))
    numbers = {name: [int(word, 16) for word in rest.split()] for name, rest in said.items()
               if name in ("run", "instructions", "stack", "differing")}
    ticks, hash_, faults = numbers["run"]
    result = {"ticks": ticks, "hash": f"{hash_:016x}", "mode": said["mode"], "faults": faults,
              "fault_names": [rest for name, _, rest in lines if name == "fault"]}
    if "instructions" in numbers:
        least, total, most = numbers["instructions"]
        result["instructions"] = {"least": least, "mean": total / max(ticks, 1), "most": most}
        result["stack_used"] = numbers["stack"][0]
    if "differing" in numbers:
        result["differing"], result["first_differing"] = numbers["differing"]
    return result


def import_log(scene, records, log):
    """An event log of a run's records."""
    _mctau("import", scene.path, "--precision", scene.precision, *_overrides(scene.assignments), "--records", records, "-o", log)


def faults_text(run):
    return "no fault" if run["faults"] == 0 else f"latched: {', '.join(run['fault_names'])}"


# --- what an image takes ---

PUSHED = re.compile(r"^(v?)(?:push|stmdb)(?:\.w)?\s+(?:sp!, )?\{(.*)\}")
LOWERED = re.compile(r"^sub(?:w|\.w)?\s+sp, (?:sp, )?#(\d+)")
STORED = re.compile(r"^v?strd?(?:\.w)?\s+.*\[sp, #-(\d+)\]!")
INDIRECT = re.compile(r"^b(?:lx|x)\s+(?!lr)r\d+|^b(?:lx|x)\s+(?:ip|sl|fp)")


def _registers(text, is_vector):
    total = 0
    for part in text.split(","):
        first, _, last = part.strip().partition("-")
        number = int(last[1:]) - int(first[1:]) + 1 if last else 1
        total += number * (8 if is_vector and first.startswith("d") else 4)
    return total


def _frames(image, code):
    """Bytes that each function takes of the stack, all of its pushes together, and those that call by address."""
    frames, by_address = dict.fromkeys(code.starts, 0), set()
    for line in counts.output(["arm-none-eabi-objdump", "-d", "--no-show-raw-insn", image]).splitlines():
        place, _, rest = line.partition(":\t")
        if not rest:
            continue
        own = code.function_at(int(place, 16))
        text = re.sub(r"\s+", " ", rest.split(";")[0].split("@")[0].strip())
        if found := PUSHED.match(text):
            frames[own] += _registers(found.group(2), found.group(1))
        elif found := LOWERED.match(text) or STORED.match(text):
            frames[own] += int(found.group(1))
        elif INDIRECT.match(text):
            by_address.add(own)
    return frames, by_address


def _taken_addresses(image, code):
    """Functions whose address stands in the image as a number: what a call by address can come to."""
    with tempfile.NamedTemporaryFile() as binary:
        counts.output(["arm-none-eabi-objcopy", "-O", "binary", image, binary.name])
        data = pathlib.Path(binary.name).read_bytes()
    words = set(struct.unpack(f"<{len(data) // 4}I", data[: len(data) // 4 * 4]))
    handlers = set(struct.unpack("<15I", data[4:64]))
    return {start for start in code.starts if start | 1 in words and start | 1 not in handlers}


def stack(image):
    """
    Most bytes of stack that any chain of calls takes, from reset. A call by address may come to any function whose address
    is taken and that is not in the chain already; that nothing calls itself is how mctau is written.
    """
    code = counts.Code(image)
    frames, by_address = _frames(image, code)
    taken = _taken_addresses(image, code)

    def deepest(function, chain):
        callees = set(code.callees[function]) | (taken if function in by_address else set())
        return frames[function] + max((deepest(one, chain | {one}) for one in callees - chain), default=0)

    begin = code.address_of("Reset_Handler")
    return deepest(begin, {begin})


def memory(image):
    """Bytes of flash and RAM: what is in the image, and its data with the most that the stack can take."""
    text, data, bss = (int(word) for word in counts.output(["arm-none-eabi-size", image]).splitlines()[1].split()[:3])
    most = stack(image)
    return {"flash": text + data, "data": data + bss, "stack": most, "ram": data + bss + most}
