"""The CAN lab: a machine with CAN interfaces, for tests and for tools/lab.

    from lab import machine

    result = machine.run(
        [
            Step("talk", "record log vcan0; cansend vcan0 123#11; stop log; log log"),
            Step("list", "mctau list"),
        ],
        files={"mctau": "build/host/mctau"},
    )
    assert result.out("talk") == "vcan0 123#11\\n"

A battery of steps runs in one of two machines, in one boot:

- Emulated: QEMU without KVM, Debian's kernel, vcan0, and can0 and can1: two SJA1000 controllers on one bus at
  1 Mbit/s. It counts instructions instead of time (COUNTED), so a battery always ends in the same bits. That
  is no measure of time: the lab is for behaviour, never for latency.
- Native: this machine, in a network namespace of its own, where its kernel has vcan. No can0 and can1.

MCTAU_LAB=emulated or native forbids the other.

A step is a piece of plain shell (sh -eu); the helpers it may use are in guest.sh. There is no Python in the
emulated machine: busybox, iproute2, can-utils, and the programs given as files, with their shared libraries.

What the emulated machine is made of is fetched once, by "python3 machine.py fetch" (tools/setup does it),
into build/lab: Debian packages, unpacked, not installed. Only qemu-system-x86 and iproute2 are installed.
"""

import dataclasses
import functools
import io
import lzma
import os
import pathlib
import platform
import re
import shutil
import stat
import subprocess
import sys
import tarfile
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
LAB = pathlib.Path(os.environ.get("MCTAU_LAB_FILES", HERE.parent.parent / "build" / "lab"))
FILES = LAB / "files"

QEMU = "qemu-system-x86_64"
KERNEL = "linux-image-amd64"
PACKAGES = ("busybox-static", "can-utils")
MODULES = ("can", "can-raw", "can-dev", "vcan", "sja1000", "kvaser_pci")  # in the order of their dependence
CAN_UTILS = ("candump", "cansend", "cangen", "canplayer", "cansequence", "canbusload")

BOOT_SECONDS = 40  # it takes 6; the rest is for a busy host
STEP_SECONDS = 20


class Unavailable(Exception):
    """There is no such machine here; the text says why and what would help."""


class LabError(Exception):
    """The machine itself failed: panic, hang, no end. The text has the console's last lines; result, where
    there is one, what had come until then."""

    def __init__(self, text, result=None):
        super().__init__(text)
        self.result = result


@dataclasses.dataclass(frozen=True)
class Step:
    """One piece of a battery. name: of letters, digits, _ ; script: plain shell, in which the first failing
    command is the step's exit code; limit: [s], then the step is killed (137) and the next one follows;
    controllers: needs can0 and can1, so the emulated machine; clock: keeps a clock, so rather the emulated
    machine, whose clock waits for it."""

    name: str
    script: str
    limit: int = STEP_SECONDS
    controllers: bool = False
    clock: bool = False


@dataclasses.dataclass(frozen=True)
class Done:
    """What came of a step. seconds are the machine's own, in steps of 10 ms."""

    code: int
    out: str
    err: str
    seconds: float


class Result:
    """What came of a battery: steps (name: Done), files (name: bytes) that the steps left in $OUT, missing
    (name: why) of steps for which there was no machine, emulated (names of the steps that ran in the
    emulated machine), and the console's text."""

    def __init__(self):
        self.steps, self.files, self.missing, self.emulated, self.console = {}, {}, {}, set(), ""

    def __getitem__(self, name):
        if name in self.missing:
            raise Unavailable(self.missing[name])
        return self.steps[name]

    def out(self, name, code=0):
        """The step's stdout, once it is certain that it ended with that exit code."""
        done = self[name]
        assert done.code == code, f"step {name}: exit {done.code}\n{done.out[-2000:]}\n{done.err[-2000:]}"
        return done.out

    def text(self, file):
        """A file from $OUT, as text."""
        return self.files[file].decode()

    def frames(self, name, interface=None):
        """[(seconds, interface, ID, data as hex)] of a log that record NAME or candump -L made."""
        lines = (line.split() for line in self.text(f"{name}.out").splitlines())
        seen = [(float(time.strip("()")), where, *frame.split("#")) for time, where, frame in lines]
        return [frame for frame in seen if interface in (None, frame[1])]

    def _add(self, entries):
        """entries: {"result/name.code": bytes, "out/file": bytes}."""
        for path, data in entries.items():
            folder, _, name = path.partition("/")
            if folder == "out":
                self.files[name] = data
            elif name.endswith(".code"):
                out, err, time = (entries[f"{path[:-5]}.{end}"].decode(errors="replace") for end in
                                  ("out", "err", "time"))
                begin, end = map(float, time.split())
                self.steps[name[:-5]] = Done(int(data), out, err, round(end - begin, 2))


def run(steps, files=None, timeout=60):
    """Runs the battery: each step on this machine if it has vcan and that is enough for the step, else in the
    emulated one. Raises Unavailable only when no step could run; see Result.missing for a part.

    files: name in $IN -> path, or bytes. Programs are made executable and bring their shared libraries along.
    timeout: [s] for all steps, without the boot.
    """
    result = Result()
    native = [] if native_reason() else [step for step in steps if serves(step)]
    emulated = [step for step in steps if step not in native]
    if native:
        run_native(result, native, files or {}, timeout)
    if emulated:
        if reason := emulated_reason():
            if not native:
                raise Unavailable(f"{reason}; nor here: {native_reason()}")
            result.missing = {step.name: f"needs can0 and can1: {reason}" for step in emulated}
        else:
            run_emulated(result, emulated, files or {}, timeout)
            result.emulated = {step.name for step in emulated}
    result.steps = {step.name: result.steps[step.name] for step in steps if step.name in result.steps}
    return result


def serves(step):
    """Whether a step is for this machine, where it has vcan."""
    return not step.controllers and (not step.clock or emulated_reason() is not None)


def available():
    """None, or why there is no machine at all."""
    reason = emulated_reason()
    return reason if reason and native_reason() else None


@functools.cache
def emulated_reason():
    """None, or why there is no emulated machine."""
    if os.environ.get("MCTAU_LAB") == "native":
        return "MCTAU_LAB=native forbids the emulated machine"
    if platform.machine() != "x86_64":
        return f"the emulated machine is an x86_64, the programs here are for {platform.machine()}"
    for command in (QEMU, "ip", "ldd"):
        if not which(command):
            return f"no {command}: run tools/setup"
    if not fetched():
        return "the emulated machine's kernel has not been fetched: run tools/setup"
    return None


@functools.cache
def native_reason():
    """None, or why this machine itself cannot serve."""
    if os.environ.get("MCTAU_LAB") == "emulated":
        return "MCTAU_LAB=emulated forbids this machine"
    for command in ("unshare", "ip", "timeout", "candump", "cansend", "cangen"):
        if not which(command):
            return f"no {command} (tools/setup)"
    try:
        tried = subprocess.run([*namespace(), which("ip"), "link", "add", "vcan0", "type", "vcan"],
                               timeout=20, capture_output=True, text=True)
    except subprocess.TimeoutExpired:
        return "making a network namespace hangs"
    return None if tried.returncode == 0 else f"this kernel gives no vcan: {tried.stderr.strip()}"


def search_path():
    """sbin too, which an ordinary user may not have on the path, and what has been fetched."""
    return os.pathsep.join([os.environ.get("PATH", os.defpath), "/usr/sbin", "/sbin", str(FILES / "usr/bin")])


def which(command):
    return shutil.which(command, path=search_path())


# Native


def namespace():
    """A network, and a process tree that dies as a whole. Root needs no user namespace; a chroot has none."""
    user = [] if os.geteuid() == 0 else ["--map-root-user"]
    return ["unshare", *user, "--net", "--mount", "--pid", "--fork", "--kill-child", "--mount-proc"]


NATIVE = """
. "$LAB/guest.sh"
ip link set lo up && ip route add 224.0.0.0/4 dev lo || exit
ip link add vcan0 type vcan && ip link set vcan0 up || exit
mount -t sysfs sys /sys # this namespace's interfaces, for counts; the host's otherwise
for step in "$LAB"/steps/*; do
    run_step "${step##*/}"
done
"""


def run_native(result, steps, files, timeout):
    with tempfile.TemporaryDirectory(prefix="mctau-lab-") as folder:
        folder = pathlib.Path(folder)
        for name in ("out", "result"):
            (folder / name).mkdir()
        for name, content in layout(steps, files).items():
            path = folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)
            path.chmod(0o755)
        environment = {**os.environ, "LAB": str(folder), "PATH": search_path()}
        try:
            done = subprocess.run([*namespace(), "sh", "-c", NATIVE], env=environment, text=True,
                                  timeout=timeout, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        except subprocess.TimeoutExpired as error:
            raise LabError(f"the battery took longer than {timeout} s\n{tail(error.stdout)}") from None
        result.console += done.stdout
        if done.returncode != 0:
            raise LabError(f"no vcan0 in the namespace:\n{tail(done.stdout)}")
        result._add({str(path.relative_to(folder)): path.read_bytes() for part in ("result", "out")
                     for path in (folder / part).rglob("*") if path.is_file()})


def layout(steps, files):
    """What lies under $LAB: {path: bytes}."""
    laid = {"guest.sh": (HERE / "guest.sh").read_bytes()}
    for number, step in enumerate(steps, 1):
        assert re.fullmatch(r"\w+", step.name), f"not a step's name: {step.name!r}"
        laid[f"steps/{number:02}-{step.name}"] = f"# limit {step.limit}\n{step.script}\n".encode()
    assert len(laid) == len({step.name for step in steps}) + 1, "two steps have one name"
    for name, content in files.items():
        laid[f"in/{name}"] = content if isinstance(content, bytes) else pathlib.Path(content).read_bytes()
    return laid


# Emulated


def run_emulated(result, steps, files, timeout):
    with tempfile.TemporaryDirectory(prefix="mctau-lab-") as folder:
        folder = pathlib.Path(folder)
        (folder / "initramfs").write_bytes(initramfs(layout(steps, files), files))
        command = [*emulator(folder / "initramfs"), *COUNTED, "-serial", "stdio", "-serial",
                   f"file:{folder / 'sent'}"]
        try:
            done = subprocess.run(command, timeout=BOOT_SECONDS + timeout, stdin=subprocess.DEVNULL,
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
            console, problem = done.stdout, None
        except subprocess.TimeoutExpired as error:
            console = error.stdout
            problem = f"the machine was not through after {BOOT_SECONDS} + {timeout} s"
        text = (console or b"").decode(errors="replace")
        result.console += text
        result._add(unpacked(folder / "sent"))
        if problem is None and not re.search(r"^lab: end\r?$", text, re.M):
            problem = "the machine ended before its work"
        elif problem is None and any(step.name not in result.steps for step in steps):
            problem = "what the machine sent is not whole"
        if problem:
            raise LabError(f"{problem}; its console's last lines:\n{tail(text)}", result)


# The machine's clock counts its instructions, 2 ns each, and jumps over idle time. So a busy host makes no
# tick late, a machine that waits takes no time, and with a fixed seed and date every run has the same bits.
COUNTED = ("-icount", "shift=1,sleep=off", "-seed", "1", "-rtc", "base=2020-01-01T00:00:00,clock=vm")


def emulator(initramfs):
    # rdrand: without it the kernel's random numbers take seconds to begin.
    return [which(QEMU), "-accel", "tcg", "-cpu", "qemu64,+rdrand", "-m", "512", "-nodefaults", "-display",
            "none", "-no-reboot", "-object", "can-bus,id=bus", "-device", "kvaser_pci,canbus=bus", "-device",
            "kvaser_pci,canbus=bus", "-kernel", str(FILES / "vmlinux"), "-initrd", str(initramfs), "-append",
            "console=ttyS0 quiet panic=-1"]


def shell(files):
    """A shell in the emulated machine at this terminal, in real time; gives QEMU's exit code."""
    if reason := emulated_reason():
        raise Unavailable(reason)
    with tempfile.TemporaryDirectory(prefix="mctau-lab-") as folder:
        packed = pathlib.Path(folder, "initramfs")
        packed.write_bytes(initramfs(layout([], files) | {"shell": b""}, files))
        return subprocess.run([*emulator(packed), "-serial", "mon:stdio"]).returncode


def unpacked(sent):
    """{path: bytes} of the joined archives that init.sh sent; of one that was cut off, what is whole."""
    entries = {}
    try:
        with tarfile.open(sent, "r:gz", ignore_zeros=True) as archive:
            for entry in archive:
                if entry.isfile():
                    entries[entry.name] = archive.extractfile(entry).read()
    except (tarfile.TarError, EOFError, OSError):
        pass
    return entries


def tail(text, lines=60):
    text = text.decode(errors="replace") if isinstance(text, bytes) else text or ""
    return "\n".join(text.replace("\r", "").splitlines()[-lines:])


def initramfs(laid, files):
    """The emulated machine's file system: a cpio archive, made anew for each run (that takes 0.1 s)."""
    entries = {}  # path -> bytes of a file, or text: where a link points
    # The host's own sh (Debian: dash), as in a native machine: busybox's prefers its own commands to PATH.
    programs = {"/bin/sh": which("sh"), "/sbin/ip": which("ip")}
    programs |= {f"/usr/bin/{name}": FILES / "usr/bin" / name for name in CAN_UTILS}
    entries["/init"] = (HERE / "init.sh").read_bytes()
    entries["/busybox/busybox"] = (FILES / "bin/busybox").read_bytes()
    entries["/modules/order"] = "".join(f"{name}\n" for name in MODULES).encode()
    for name in MODULES:
        entries[f"/modules/{name}.ko"] = (FILES / "modules" / f"{name}.ko").read_bytes()
    for path, program in programs.items():
        entries[path] = pathlib.Path(program).read_bytes()
    for path, content in laid.items():
        entries[f"/lab/{path}"] = content
    given = [path for path in files.values() if not isinstance(path, bytes)]
    for program in (*programs.values(), *given):
        for library in libraries(program):
            entries[library] = pathlib.Path(library).read_bytes()

    archive = io.BytesIO()
    folders = {str(parent) for path in entries for parent in pathlib.PurePath(path).parents if parent.name}
    everything = [*((folder, None) for folder in sorted(folders)), *entries.items()]
    for number, (path, content) in enumerate(everything, 1):
        if content is None:
            mode, content = stat.S_IFDIR | 0o755, b""
        elif isinstance(content, str):
            mode, content = stat.S_IFLNK | 0o777, content.encode()
        else:
            mode = stat.S_IFREG | 0o755
        cpio_entry(archive, number, path[1:], mode, content)
    # The kernel opens the console before it starts init, so this node must be there.
    cpio_entry(archive, len(everything) + 1, "dev", stat.S_IFDIR | 0o755, b"")
    cpio_entry(archive, len(everything) + 2, "dev/console", stat.S_IFCHR | 0o600, b"", device=(5, 1))
    cpio_entry(archive, 0, "TRAILER!!!", 0, b"")
    return archive.getvalue()


def cpio_entry(archive, number, name, mode, content, device=(0, 0)):
    """The "newc" format: 13 hexadecimal numbers, the name and the content, each padded to 4 bytes."""
    fields = (number, mode, 0, 0, 1, 0, len(content), 0, 0, *device, len(name) + 1, 0)
    archive.write(b"070701" + b"".join(b"%08x" % field for field in fields) + name.encode() + b"\0")
    archive.write(bytes(-archive.tell() % 4) + content)
    archive.write(bytes(-archive.tell() % 4))


def libraries(program):
    """Paths of the shared libraries and the loader that a program needs; none for a script."""
    with open(program, "rb") as file:
        if file.read(4) != b"\x7fELF":
            return []
    listed = subprocess.run([which("ldd"), str(program)], capture_output=True, text=True).stdout
    if missing := re.search(r"(\S+) => not found", listed):
        raise LabError(f"{program} needs {missing[1]}, which is not here")
    return re.findall(r"(/\S+) \(0x", listed)


# Fetch


def fetched():
    return (FILES / "complete").exists()


def fetch():
    """Makes FILES complete; quick when it is. Needs apt-get and dpkg-deb, not root."""
    if fetched():
        return
    shutil.rmtree(FILES, ignore_errors=True)
    LAB.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="fetch-", dir=LAB) as folder:
        folder = pathlib.Path(folder)
        # Package lists of its own: the system's may be missing or old, and are root's to change.
        for name in ("lists/partial", "cache/archives/partial"):
            (folder / name).mkdir(parents=True)
        options = [f"-o{option}" for option in (
            f"Dir::State::Lists={folder / 'lists'}", f"Dir::Cache={folder / 'cache'}", "Acquire::Retries=3",
            "Acquire::Languages=none", "APT::Sandbox::User=root")]
        called(["apt-get", *options, "update"])
        depends = called(["apt-cache", *options, "depends", KERNEL])
        kernel = re.search(r"Depends: (linux-image-\S+)", depends)[1]
        called(["apt-get", *options, "download", kernel, *PACKAGES], cwd=folder)

        files = folder / "files"
        for name in ("bin", "usr/bin", "modules"):
            (files / name).mkdir(parents=True)
        for package in folder.glob("*.deb"):
            unpack(package, files)
        needed = [files / "vmlinux", files / "bin/busybox", *(files / "usr/bin" / name for name in CAN_UTILS),
                  *(files / "modules" / f"{name}.ko" for name in MODULES)]
        if absent := [path.name for path in needed if not path.exists()]:
            raise LabError(f"not in the packages: {', '.join(absent)}")
        (files / "complete").write_text("".join(f"{path.name}\n" for path in sorted(folder.glob("*.deb"))))
        files.rename(FILES)


def unpack(package, files):
    """Takes the kernel, the modules and the programs out of a Debian package."""
    with subprocess.Popen(["dpkg-deb", "--fsys-tarfile", package], stdout=subprocess.PIPE) as process:
        with tarfile.open(fileobj=process.stdout, mode="r|") as archive:
            for entry in archive:
                name = pathlib.PurePath(entry.name)
                if not entry.isfile():
                    continue
                if name.name.startswith("vmlinuz"):
                    (files / "vmlinux").write_bytes(vmlinux(archive.extractfile(entry).read()))
                elif name.name.removesuffix(".xz").removesuffix(".ko") in MODULES:
                    data = archive.extractfile(entry).read()
                    if name.suffix == ".xz":  # as later kernels have them
                        data = lzma.decompress(data)
                    (files / "modules" / name.name.removesuffix(".xz")).write_bytes(data)
                elif name.parent.name == "bin":
                    (files / name).write_bytes(archive.extractfile(entry).read())
                    (files / name).chmod(0o755)
    if process.returncode != 0:
        raise LabError(f"dpkg-deb cannot unpack {package.name}")


def vmlinux(image):
    """The kernel inside a compressed one: QEMU starts it directly, which saves the emulated unpacking."""
    begin = image.find(b"\xfd7zXZ\0")
    return lzma.LZMADecompressor().decompress(image[begin:]) if begin >= 0 else image


def called(command, **options):
    done = subprocess.run(command, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, **options)
    if done.returncode != 0:
        raise LabError(f"failed: {' '.join(command[:1] + command[-2:])}\n{tail(done.stdout, 8)}")
    return done.stdout


if __name__ == "__main__":
    if sys.argv[1:] != ["fetch"]:
        sys.exit("usage: machine.py fetch")
    try:
        fetch()
    except (LabError, OSError) as error:
        sys.exit(f"machine.py: {error}")
