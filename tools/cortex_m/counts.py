"""Instructions of the steppers on an emulated Cortex-M: builds what is needed, runs it, reads what it says.

    measured = counts.measure("scenes/cart_pole.toml", target="cortex-m4f")
    measured["steppers"][0]["step"]["mean"]
"""

import bisect
import contextlib
import fcntl
import os
import pathlib
import re
import shutil
import subprocess
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
TARGETS = {"cortex-m4f": "m4f", "cortex-m7": "m7"}
PRECISIONS = {"float": "f32", "double": "f64"}
LIBRARIES = {"float": "libmctau_f32.a", "double": "libmctau.a"}
PACKAGES = "gcc-arm-none-eabi libnewlib-arm-none-eabi qemu-system-arm"
NEEDED = ("arm-none-eabi-gcc", "qemu-system-arm", "cmake", "ninja", "cc")
MOST_TICKS = 10000
RUN_SECONDS = 600


class Unavailable(Exception):
    """Something is missing, or cannot be built; the text says what and what would help."""


class Failed(Unavailable):
    """A program failed; `said` is all that it printed."""

    def __init__(self, text, said):
        super().__init__(text)
        self.said = said


class BadScene(Exception):
    """The scene is wrong; the text is the reader's."""


# --- what there is ---


def missing():
    """Why nothing can be counted on this machine, or None."""
    without = [name for name in NEEDED if shutil.which(name) is None]
    if not without:
        library = output(["arm-none-eabi-gcc", "-print-file-name=libc.a"]).strip()
        without = [] if os.path.isabs(library) else ["newlib, its C library"]
    if not without:
        return None
    return f"there is no {', no '.join(without)} here; run tools/setup --cortex-m, or: apt-get install {PACKAGES}"


def host_build():
    return pathlib.Path(os.environ.get("MCTAU_BUILD", ROOT / "build" / "host"))


def output(command, timeout=RUN_SECONDS, **options):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=timeout, **options)
    if done.returncode:
        what = " ".join(str(word) for word in command[:3])
        said = (done.stdout + done.stderr).splitlines()
        errors = [line for line in said if "error" in line.lower()] or said
        raise Failed("\n".join([f"{what} ...: exit code {done.returncode}", *errors[:20]]), "\n".join(said))
    return done.stdout


# --- building ---


def compile_here(program, precision, sources, build):
    """A program for this machine, with the library as it is built here."""
    library = build / LIBRARIES[precision]
    headers = (ROOT / "include/mctau").glob("*.h")
    if not library.exists() or any(header.stat().st_mtime > library.stat().st_mtime for header in headers):
        raise Unavailable(f"{library} is not built, or older than its headers: cmake --build --preset host")
    includes = [f"-I{place}" for place in (build / "include" / precision, ROOT / "include", ROOT)]
    files = [HERE / source for source in sources]
    options = ["-std=c99", "-O1", "-ffp-contract=off", "-D_POSIX_C_SOURCE=200809L"]
    output(["cc", *options, *includes, *files, library, "-lpthread", "-lrt", "-o", program])


def build_folder(target):
    folder = ROOT / "build" / f"cortex-{TARGETS[target]}"
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def build_target(target, name, file=None):
    """Path of an image, or another file, of hal/cortex_m/CMakeLists.txt, built anew where it is old."""
    kind = TARGETS[target]
    folder = build_folder(target)
    with open(folder / ".lock", "w", encoding="utf-8") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)  # two at once would build one folder
        if not (folder / "build.ninja").exists():
            output(["cmake", "-S", ROOT / "hal/cortex_m", "-B", folder, "-G", "Ninja", "--toolchain",
                     ROOT / f"cmake/cortex-{kind}.cmake"])
        output(["ninja", "-C", folder, "-j", min(2, os.cpu_count() or 1), name])
    return folder / (file or f"{name}.elf")


def build_image(target, system, precision):
    """Path of the image that counts the steppers of one system."""
    return build_target(target, f"count_{system}_{PRECISIONS[precision]}")


@contextlib.contextmanager
def job_of(scene, ticks, assignments=(), build=None):
    """A scene as the images read it, with the inputs of its run: the job's file and the system's name."""
    build = build or host_build()
    precision = "double" if (build / LIBRARIES["double"]).exists() else "float"
    with tempfile.TemporaryDirectory() as folder:
        program, file = pathlib.Path(folder, "scene_job"), pathlib.Path(folder, "job")
        compile_here(program, precision, ["scene_job.c"], build)
        done = subprocess.run([program, str(scene), file, str(ticks), *assignments], capture_output=True, text=True)
        if done.returncode:
            raise (BadScene if done.returncode == 2 else Unavailable)(done.stderr.strip())
        yield file, done.stdout.strip()


# --- running ---


def _range(words, ticks):
    least, most, total = (int(word, 16) for word in words)
    return {"least": least, "mean": total / ticks, "most": most}


def _read(printed):
    """What count.c prints: the number of ticks, and a row for each stepper."""
    first, *lines = printed.splitlines()
    ticks = int(first.removeprefix("ticks"), 16)
    rows = []
    for line in lines:
        stepper, state_hash, diverged, *words, kernel = line.split()
        rows.append({
            "stepper": stepper,
            "step": _range(words[:3], ticks),
            "tick": _range(words[3:], ticks),
            "diverged_ticks": int(diverged, 16),
            "hash": state_hash,
            "kernel": int(kernel, 16) & ~1,  # the lowest bit says Thumb
        })
    return ticks, rows


def run_image(target, image, job):
    """Number of ticks, and a row for each stepper that suits the scene."""
    return _read(output([ROOT / "hal/cortex_m/run", TARGETS[target], image, job]))


def run_here(job, precision, build=None):
    """The same runs on this machine: rows whose counts mean nothing and whose hashes must be the same."""
    with tempfile.TemporaryDirectory() as folder:
        program = pathlib.Path(folder, "count")
        compile_here(program, precision, ["count.c", "native.c"], build or host_build())
        return _read(output([program], env=os.environ | {"IMAGE_ARGUMENTS": str(job)}))


# --- code ---


class Code:
    """Functions of an image: their names, sizes, and which ones each calls or jumps to."""

    BRANCH = re.compile(r"^ +([0-9a-f]+):\s+c?b\S*\s+(?:\w+, )?([0-9a-f]+) <", re.MULTILINE)

    def __init__(self, image):
        self.names, self.sizes = {}, {}
        for line in output(["arm-none-eabi-nm", "-S", image]).splitlines():
            place, *size, kind, name = line.split()  # what libgcc has in assembler may have no size
            if kind in "tTwW":
                address = int(place, 16) & ~1
                self.names.setdefault(address, set()).add(name)
                self.sizes[address] = max(self.sizes.get(address, 0), int(size[0], 16) if size else 0)
        self.starts = sorted(self.names)
        self.callees = {start: set() for start in self.starts}
        for match in self.BRANCH.finditer(output(["arm-none-eabi-objdump", "-d", "--no-show-raw-insn", image])):
            own, other = (self.function_at(int(word, 16)) for word in match.groups())
            if own is not None and other is not None:
                self.callees[own].add(other)

    def function_at(self, address):
        place = bisect.bisect_right(self.starts, address) - 1
        return self.starts[place] if place >= 0 else None

    def address_of(self, name):
        return next(start for start, names in self.names.items() if name in names)

    def reached_from(self, address):
        """Addresses of a function and of all that it comes to."""
        found, open_ = set(), [address]
        while open_:
            one = open_.pop()
            if one not in found:
                found.add(one)
                open_ += self.callees[one]
        return found

    def size_from(self, address):
        return sum(self.sizes[one] for one in self.reached_from(address))

    def names_from(self, address):
        return {name for one in self.reached_from(address) for name in self.names[one]}


# --- all of it ---


def measure(scene, target="cortex-m4f", precisions=tuple(PRECISIONS), ticks=1000, assignments=()):
    """Instructions of every stepper that suits a scene; raises BadScene or Unavailable.

    Of each: `step`, a further step of the kernel; `tick`, all of mct_plant_step with one step; `beside`, what of the mean
    tick is not the step, so that a tick of n steps takes beside + n step; `flash`, bytes of the kernel with all that
    it calls.
    """
    why = missing()
    if why:
        raise Unavailable(why)
    rows = []
    with job_of(scene, ticks, assignments) as (job, system):
        for precision in precisions:
            image = build_image(target, system, precision)
            ticks, found = run_image(target, image, job)
            code = Code(image)
            for row in found:
                row["precision"] = precision
                row["beside"] = max(0, row["tick"]["mean"] - row["step"]["mean"])
                row["flash"] = code.size_from(row.pop("kernel"))
            rows += found
    compiler = output(["arm-none-eabi-gcc", "--version"]).splitlines()[0]
    about = {"scene": str(scene), "system": system, "target": target, "compiler": compiler}
    return about | {"ticks": ticks, "steppers": rows}
