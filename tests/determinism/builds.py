"""Builds tests/determinism/bits.c with core and sim HAL in many ways, and runs it.

Ninja does the work, running included: two programs at a time, and at the second run only what has changed.
"""

import os
import pathlib
import shutil
import subprocess

PRECISIONS = {"double": "0", "float": "1"}
# What every user of the library needs, as CMakeLists.txt gives it; no option beside may be needed for the same bits.
ALWAYS = "-std=c99 -ffp-contract=off -D_POSIX_C_SOURCE=200809L"
# gcc's vectoriser of straight code makes fused operations of sums beside differences, whatever -ffp-contract says.
OWN = {"gcc": "-fno-tree-slp-vectorize", "clang": ""}
CONFIGURATIONS = [(compiler, options) for compiler in ("gcc", "clang")
                  for options in ("-O0", "-O2", "-O3 -march=native")]
REFERENCE = ("gcc", "-O2")
GOLDEN = pathlib.Path(__file__).parent.parent / "golden" / "bits.txt"


def name_of(configuration):
    return "_".join(configuration).replace(" ", "").replace("-", "_").replace("=", "_")


def missing(configuration):
    """Why a configuration cannot be built here, or None."""
    return None if shutil.which(configuration[0]) else f"{configuration[0]} is not installed; run tools/setup"


class Builds:
    """Builds of some configurations in one folder."""

    def __init__(self, source, folder, configurations):
        self.source = pathlib.Path(source)
        self.folder = pathlib.Path(folder)
        self.wanted = [each for each in configurations if missing(each) is None]
        self.folder.mkdir(parents=True, exist_ok=True)
        self._write_config()
        self._write_if_changed(self.folder / "build.ninja", "\n".join(self._rules()) + "\n")

    def build(self):
        """Builds and runs as much as can be; gives the output, for where something is missing."""
        done = subprocess.run(["ninja", "-C", self.folder, "-k", "0", "-j", str(min(2, os.cpu_count() or 1))],
                              capture_output=True, text=True)
        return done.stdout + done.stderr

    def objects(self, configuration, precision, room):
        """Object files of a room, src or hal."""
        folder = self.folder / name_of(configuration) / precision / room
        return sorted(str(file) for file in folder.rglob("*.o"))

    def lines(self, configuration):
        """What the programs of both precisions have printed."""
        folder = self.folder / name_of(configuration)
        return [line for precision in PRECISIONS for line in (folder / precision / "bits.txt").read_text().splitlines()]

    def _sources(self):
        files = [file for room in ("src", "hal/sim") for file in sorted((self.source / room).rglob("*.c"))]
        return files + [self.source / "hal" / "clock.c", self.source / "tests" / "determinism" / "bits.c"]

    def _write_config(self):
        template = (self.source / "cmake" / "config.h.in").read_text()
        for precision, is_float in PRECISIONS.items():
            folder = self.folder / "include" / precision / "mctau"
            folder.mkdir(parents=True, exist_ok=True)
            text = template.replace("@MCT_REAL_IS_FLOAT@", is_float).replace("@PROJECT_VERSION@", "0")
            self._write_if_changed(folder / "config.h", text)

    def _rules(self):
        yield "rule compile"
        yield "  command = $compiler $options -MD -MF $out.d -c $in -o $out"
        yield "  depfile = $out.d"
        yield "  deps = gcc"
        yield "rule link"
        yield "  command = $compiler $in -o $out"
        yield "rule run"
        yield "  command = $in > $out.part && mv $out.part $out"
        scenes = sorted((self.source / "scenes").glob("*.toml"))
        scenes = " ".join(str(path) for path in scenes if "_free" not in path.name)
        includes = " ".join(f"-I{self.source / place}" for place in ("include", "src", "."))
        for configuration in self.wanted:
            compiler, options = configuration
            # Another version of the compiler must not be taken for the one that made an object.
            version = subprocess.run([compiler, "-dumpfullversion", "-dumpversion"], capture_output=True,
                                     text=True, check=True).stdout.strip()
            always = f"{ALWAYS} {OWN[compiler]} {options} -DCOMPILER={version} {includes}"
            for precision in PRECISIONS:
                folder = f"{name_of(configuration)}/{precision}"
                objects = []
                for file in self._sources():
                    place = file.relative_to(self.source).with_suffix(".o")
                    objects.append(f"{folder}/{place}")
                    yield f"build {objects[-1]}: compile {file}"
                    yield f"  compiler = {compiler}"
                    yield f"  options = {always} -Iinclude/{precision}"
                yield f"build {folder}/bits: link {' '.join(objects)}"
                yield f"  compiler = {compiler}"
                yield f"build {folder}/bits.txt: run {folder}/bits {scenes}"

    @staticmethod
    def _write_if_changed(file, text):
        if not file.exists() or file.read_text() != text:
            file.write_text(text)
