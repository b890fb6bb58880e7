"""Off means gone: a kernel is that of a source in which the effects that it lacks had never been written.

For sets of effects that a system has kernels for, all other effects are deleted from the text of its source
(deletion.py: tests of them, dead branches, operands, what only they read), and what is left is compiled as the library
was: for all sets of a system, or, where they are many, for those that have one effect at most or lack one at most. Held
against the library's own object files, kernel by kernel, by every stepper, in double precision:

- the floating-point operations, with those of the functions called: each as often, in every kernel (SPARE has the few
  where the compiler copies a path more or less);
- reads of constants that are 0 since an effect is off: none, so nothing is multiplied by a zero of run time;
- the path as it runs, for some steppers of each system without each of its effects in turn: instructions of a step
  counted by callgrind, each as often but for moves, and the states after a thousand steps, which must have the same bits.

Moves (kernels.py says which instructions these are) are not held to the instruction: gcc gives registers in the order in
which names and branches were written, so a text with fewer of them has other spills. How many moves that are is bounded
for each kernel and close to none on average.
Effects that act outside kernels, saturation and sensors, leave no instruction there: no kernel's text names them.
"""

import os
import shlex
import shutil
import subprocess

import pytest
from checks import deletion, gone, kernels

WITHIN = 0.07  # of a kernel's executed instructions, moves with them
ON_AVERAGE = 0.01  # of them all
# Operations more or less, of some 700: of the two ways through these steps the compiler joins or copies the ends.
SPARE = {
    ("spring_pendulum", "taylor4"): 7,
    ("spring_pendulum", "taylor6"): 7,
    ("spring_pendulum", "taylor8"): 7,
    ("spring_pendulum", "taylor12"): 8,
    ("rotating_frame", "rk4"): 18,
    ("falling_sphere", "expo"): 1,
    ("reaction_wheel", "euler"): 2,
}
# Instructions more: what is called by the library's kernels, of which there are many, stands in the single kernel's place.
BY_CALL = {"pendulum_taylor4_10003": 5, "pendulum_taylor4_10041": 5}
# Compiled once for all sets of effects, and asking for them as they run: steps close to the pivot, which are rare.
ONE_FOR_ALL = {"rare_rk4", "rare_taylor"}
MANY = 40  # sets: those of a system with a motor, each of which takes a second to compile
COUNTED = ("leap", "rk4", "taylor4", "expo")  # the steppers that run, of systems that have them


@pytest.fixture(scope="module", autouse=True)
def plain_build(build):
    if os.environ.get("MCTAU_SANITIZE"):
        pytest.skip("sanitizers and coverage add instructions of their own")
    command = kernels.compile_command(build, "src/systems/cart_pole.c", "f64")
    if "-O2" not in command and "-O3" not in command:
        pytest.skip("instructions are counted in an optimised build alone")
    if "clang" in subprocess.run([command[0], "--version"], capture_output=True, text=True).stdout:
        pytest.skip("clang turns sums and products into vectors as it finds them; instructions are compared with gcc")
    if not (build / "libmctau.a").exists():
        pytest.skip("no library in double precision")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("deleted")


@pytest.fixture(scope="module")
def found(build, source, folder):
    """Those of the library's kernels that are compared; a system without effects has none."""
    found = []
    every = gone.all_kernels(build, source, folder)
    for system in dict.fromkeys(one.system for one in every):
        own = [one for one in every if one.system == system]
        sets = {one.effects for one in own}
        most = max(effects.bit_count() for effects in sets)
        found += [one for one in own if most and (len(sets) <= MANY or not 1 < one.effects.bit_count() < most - 1)]
    return found


@pytest.fixture(scope="module")
def library(build, found):
    """Functions of the library's object files, by the source's name."""
    return {file: kernels.functions(kernels.object_file(build, f"src/systems/{file}", "f64"))
            for file in {one.file for one in found}}


@pytest.fixture(scope="module")
def deleted(build, source, folder, found):
    """Object files without the other effects, by a kernel's file and effects."""
    return gone.compile_all(build, source, folder, found)


def base_name(symbol):
    """A function's name without what the compiler adds to a copy of it."""
    return symbol.partition(".")[0]


def differences(library, without, one):
    """How often the library's kernel has each operation more, and less, than that of the deleted text."""
    ours, theirs = (kernels.operations(functions, one.symbol) for functions in (library, without))
    return ours - theirs, theirs - ours


def asks_for_effects(library, one):
    return any(base_name(name) in ONE_FOR_ALL for name in kernels.called(library[one.symbol]))


def zeros_read(functions, name):
    called = kernels.called(functions[name])
    inner = [zeros_read(functions, other) for other in called if other in functions and other != name]
    return {other for other in called if other.startswith(deletion.READ)}.union(*inner)


def test_every_kernel_has_the_operations_of_a_source_without_the_effects_that_it_lacks(found, library, deleted):
    without = {pair: kernels.functions(file) for pair, file in deleted.items()}
    more = {}
    for one in found:
        ours, theirs = library[one.file], without[one.file, one.effects]
        assert not zeros_read(theirs, one.symbol), f"{one} reads what is 0 since an effect is off"
        if asks_for_effects(ours, one):
            continue
        surplus, missing = differences(ours, theirs, one)
        if sum((surplus + missing).values()) > SPARE.get((one.system, one.stepper), 0):
            more[str(one)] = f"more: {dict(surplus)}, fewer: {dict(missing)}"
    assert not more, "\n".join(f"{name}: {each}" for name, each in more.items())


# --- as it runs ---


def sets_without_one(every, masks):
    """The largest set of effects that kernels have, without each of its effects."""
    fullest = max((one.effects for one in every), key=lambda effects: (effects.bit_count(), effects))
    return {fullest & ~masks[name] for name in deletion.bits(masks)} - {fullest}


@pytest.fixture(scope="module")
def executed(build, source, folder, found, deleted):
    """Instructions of a step by kernel: the library's, and the deleted text's."""
    masks = deletion.masks(source, {})
    chosen, objects = [], []
    for system in dict.fromkeys(one.system for one in found):
        every = [one for one in found if one.system == system and one.stepper in COUNTED]
        sets = sets_without_one(every, masks)
        chosen += [one for one in every if one.effects in sets]
    for one in chosen:
        file = folder / f"{one}.o"
        shutil.copy(deleted[one.file, one.effects], file)
        for change in (f"--redefine-sym={one.symbol}={one}", f"--keep-global-symbol={one}", f"--globalize-symbol={one}"):
            subprocess.run(["objcopy", change, file], check=True)  # which takes but one of them at a time
        objects.append(file)
    rows = [f'KERNEL("{one.system}", MCT_STEPPER_{one.stepper.upper()}, {one.effects}u, {one})' for one in chosen]
    (folder / "deleted_kernels.h").write_text(" \\\n".join(["#define CASES", *rows]) + "\n")
    program = folder / "run_deleted"
    includes = [f"-I{place}" for place in (folder, build / "include/double", source / "include", source)]
    compiler = shlex.split(os.environ.get("CC", "cc"))
    subprocess.run([*compiler, "-std=gnu99", "-O2", *includes, source / "tests/checks/run_deleted.c",
                    source / "tools/benchmark/measure.c", *objects, build / "libmctau.a", "-o", program], check=True)
    count = kernels.executed(source, program)
    return {one: (count[f"library {one}"], count[f"deleted {one}"]) for one in chosen}


def test_a_step_does_what_that_of_a_source_without_the_effect_does(executed):
    assert len(executed) > 100
    more = {str(one): ours.work - theirs.work for one, (ours, theirs) in executed.items() if ours.work != theirs.work}
    assert more == BY_CALL


def test_a_step_moves_as_much_as_that_of_a_source_without_the_effect(executed):
    apart = {}
    for one, (ours, theirs) in executed.items():
        print(f"{one}: {ours.all:.0f} instructions a step, {ours.work:.0f} without moves; of the text without the effect "
              f"{theirs.all:.0f}, {theirs.work:.0f}")
        apart[str(one)] = ours.all / theirs.all - 1
    assert not {name: each for name, each in apart.items() if abs(each) > WITHIN}
    assert abs(sum(apart.values()) / len(apart)) < ON_AVERAGE


# --- whether all this would see an effect that is left behind ---


@pytest.fixture
def cart_pole(build, source, folder):
    """of(old, new): functions of the cart-pole without effects, after a change of its text, as it is and after deletion."""
    file = "src/systems/cart_pole.c"
    texts = deletion.read(source, file)
    masks = deletion.masks(source, texts)

    def of(old, new):
        assert old in texts[file]
        changed = texts | {file: texts[file].replace(old, new)}
        return [kernels.functions(gone.compiled(build, folder, file, changed, masks, 0, deletes))
                for deletes in (False, True)]

    return of


def some_kernel(found):
    return next(one for one in found if str(one) == "cart_pole_rk4_0")


def test_a_term_that_is_multiplied_by_a_zero_of_run_time_is_seen(cart_pole, found):
    _, deleted = cart_pole("    if (is_cart_damped(effects)) {\n        f1 -= k->cart_damping * pd;\n    }\n",
                           "    f1 -= k->cart_damping * pd;\n")
    assert zeros_read(deleted, some_kernel(found).symbol) == {"read_cart_damping"}


def test_a_test_of_an_effect_at_run_time_is_seen(cart_pole, found):
    given, deleted = cart_pole("MCT_INLINE bool is_cart_damped(unsigned effects)\n{\n",
                               "MCT_INLINE bool is_cart_damped(unsigned effects)\n{\n"
                               "    __asm__ volatile(\"\" : \"+r\"(effects));\n")
    surplus, missing = differences(given, deleted, some_kernel(found))
    assert surplus and not missing


# --- what is deleted ---


@pytest.mark.parametrize(("text", "left"), [
    ("if (effects & MCT_GRAVITY) { a = 1; }", ""),
    ("if (effects & MCT_GRAVITY) { a = 1; } else { a = 2; }", "{ a = 2 ; }"),
    ("if (!(effects & MCT_GRAVITY)) { a = 1; } else if (b) { a = 2; }", "{ a = 1 ; }"),
    ("if (effects & (MCT_GRAVITY | MCT_DRAG)) { a = 1; }", "if ( effects & ( MCT_DRAG ) ) { a = 1 ; }"),
    ("if ((effects & MCT_GRAVITY) && b) { a = 1; }", ""),
    ("if ((effects & MCT_GRAVITY) || b) { a = 1; }", "if ( b ) { a = 1 ; }"),
    ("if (b && !(effects & MCT_GRAVITY)) { a = 1; }", "if ( b ) { a = 1 ; }"),
    ("a = (effects & MCT_GRAVITY) ? b : (effects & MCT_DRAG) ? c : d;", "a = ( effects & MCT_DRAG ) ? c : d ;"),
    ("return (effects & MCT_MOTOR) != 0 ? f(effects & MCT_GRAVITY, b) : c;",
     "return ( effects & MCT_MOTOR ) != 0 ? f ( 0 , b ) : c ;"),
    ("const bool on = effects & MCT_GRAVITY; a = on ? k->on : c;", "a = c ;"),
    ("for (int i = 0; i < n; i++) { if (effects & MCT_GRAVITY) { a += i; } b(i); }",
     "for ( int i = 0 ; i < n ; i ++ ) { b ( i ) ; }"),
    ("a = x & y; effects &= MCT_GRAVITY;", "a = x & y ; effects &= MCT_GRAVITY ;"),
])  # fmt: skip
def test_of_a_text_nothing_but_the_effect_is_deleted(source, text, left):
    masks = deletion.masks(source, {})
    block = deletion.Deleter(masks, masks["MCT_GRAVITY"]).block(deletion.tokens_of(text))
    assert " ".join(block) == left


def test_no_test_of_a_deleted_effect_is_left(source, found):
    for file in sorted({one.file for one in found}):
        texts = deletion.read(source, f"src/systems/{file}")
        masks = deletion.masks(source, texts)
        deleter = deletion.Deleter(masks, sum(masks[name] for name in deletion.bits(masks)))
        assert not {name: left for name, text in deleter.files(texts).items() if (left := deleter.left(text))}


def test_no_kernel_knows_of_what_acts_outside(source):
    """Saturation bounds the input before a kernel sees it; sensors read states behind it: neither is in a kernel's text."""
    for room in deletion.ROOMS:
        for path in source.glob(room):
            assert "SATURATION" not in path.read_text(), path
