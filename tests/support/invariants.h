/*
 * What a mechanism keeps when it moves by itself: no input, no load, no loss. Nothing of a system is known by its name:
 * loads are parameters in N, N m or rad/s^2; energy is kept where every power of the evaluation is zero; the momentum
 * (M v)_i where energies do not depend on coordinate i and nothing acts on it; the angular momentum of a rotation where
 * nothing acts at all; and a quaternion keeps its length.
 *
 * A base or a force that is prescribed does work, so it is switched off: a moving base becomes a pendulum. What such
 * work adds up to is in the ledger of energy, tests/systems/test_ledger_f64.c.
 */
#ifndef MCT_TEST_INVARIANTS_H
#define MCT_TEST_INVARIANTS_H

#include "mctau/plant.h"

typedef enum { KEPT_ENERGY, KEPT_MOMENTUM, KEPT_ANGULAR_MOMENTUM, KEPT_LENGTH, KEPT_COUNT } kept;

typedef struct {
    bool is_kept[KEPT_COUNT];
    double drift[KEPT_COUNT]; /* the largest error so far, relative to the scale */
    double energy, potential; /* at the start [J] */
    double energy_error;
    double energy_scale; /* largest kinetic energy and exchange with the potential energy [J] */
    /* By coordinate; behind them the angular momentum about the origin, in space. */
    bool is_momentum[MCT_MAX_COORDINATES + 3];
    double momentum[MCT_MAX_COORDINATES + 3]; /* at the start */
    double momentum_error[MCT_MAX_COORDINATES + 3];
    double momentum_scale[MCT_MAX_COORDINATES + 3]; /* largest sum of its terms' sizes */
} invariants;

/* "energy", ... */
extern const char *const kept_names[KEPT_COUNT];

/*
 * A lively motion of a system without loads and losses, from its default start and a bit more; with its weight or
 * without. dt is 1 ms. False where the stepper does not suit, where there is no motion: a process, and where weight does
 * nothing but let a body fall for ever.
 */
bool invariant_scene(mct_scene *scene, int system, int stepper, bool with_weight);

/* Finds what a plant keeps and takes its values at the present state. */
void invariants_start(invariants *self, const mct_plant *plant);

/* Looks again: largest drift since the start. A plant that diverged drifts without bound. */
void invariants_look(invariants *self, const mct_plant *plant);

#endif
