"""What images take: flash, RAM, stack and instructions, and the committed table of them.

    footprint.measure(footprint.ROWS[0])["flash"]
    footprint.committed()
"""

import csv
import dataclasses

import counts
import images

FILE = counts.ROOT / "tests/golden/footprint.csv"
WITHIN = 0.05  # growth that needs no line in the changelog
FIGURES = ("flash", "data", "stack", "least", "mean", "most")
BUDGET = images.BUDGET
CENTRAL = ("cart_pole", "reaction_wheel")


@dataclasses.dataclass(frozen=True)
class Row:
    """An image: scene, changes of it, and where it runs."""

    scene: str
    changes: str = ""
    image: str = "twin"
    target: str = "qemu-m4f"

    @property
    def precision(self):
        return images.STANDARD[self.target]


def rows():
    """The ready scenes as they are, and of the central systems what else a user would ask for."""
    found = [Row(path.stem) for path in sorted((counts.ROOT / "scenes").glob("*.toml"))]
    for scene in CENTRAL:
        found += [
            Row(scene, image="controller"),
            Row(scene, target="qemu-m7"),
            Row(scene, "scene.stepper=leap"),
            Row(scene, "scene.stepper=rk4"),
            Row(scene, "scene.stepper=rk4 effects.viscous=false"),
            Row(scene, "scene.stepper=rk4 effects.saturation=off"),
            Row(scene, "scene.stepper=leap effects.motor=inductive"),
            Row(scene, "scene.stepper=rk4 effects.coulomb=moreau"),
            Row(scene, "scene.stepper=rk4 effects.drag=true"),
        ]
    return found


def measure(row):
    """Flash, data, stack [bytes] and instructions of a tick (least, mean, most), over the scene's duration."""
    with images.compiled(counts.ROOT / "scenes" / f"{row.scene}.toml", row.precision, row.changes.split()) as scene:
        image = images.build(scene, row.image, row.target)
        records = scene.folder / "records"
        if row.image == "controller":
            images.run(images.build(scene, "twin", "sil"), "sil", records)
        run = images.run(image, row.target, records if row.image == "controller" else "-")
        took = images.memory(image)
        taken = {key: round(value) for key, value in run["instructions"].items()}
        return {"kernel": scene.kernel if row.image == "twin" else "", "flash": took["flash"], "data": took["data"],
                "stack": took["stack"], **taken}


# --- the committed table ---


def committed():
    """Figures by row, and the sentence of the changelog that allowed the last growth."""
    lines = FILE.read_text().splitlines() if FILE.exists() else ["# "]
    known = {}
    for line in csv.DictReader(lines[1:]):
        row = Row(line["scene"], line["changes"], line["image"], line["target"])
        known[row] = {"kernel": line["kernel"], **{figure: int(line[figure]) for figure in FIGURES}}
    return known, lines[0].removeprefix("# ")


def grown(before, now):
    """The figures of a row that have grown by more than WITHIN, as words."""
    return [f"{figure} {before[figure]} -> {now[figure]}" for figure in FIGURES if now[figure] > (1 + WITHIN) * before[figure]]


def write(measured, why):
    with open(FILE, "w", encoding="utf-8", newline="") as file:
        file.write(f"# {why}\n")
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["scene", "changes", "image", "target", "kernel", *FIGURES])
        for row, figures in measured.items():
            table.writerow([row.scene, row.changes, row.image, row.target, figures["kernel"],
                            *(figures[figure] for figure in FIGURES)])
