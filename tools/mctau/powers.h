/* Energies, and the powers that change them: the accounts of a ledger. */
#ifndef MCTAU_TOOLS_POWERS_H
#define MCTAU_TOOLS_POWERS_H

#include <stdbool.h>
#include <stdint.h>

#include "mctau/effects.h"

/* At a state, or what they gain [J]; powers bring [W]. */
typedef struct {
    double kinetic, potential, magnetic;
} energies;

/* The effects, by their places in mct_effects, and what else mct_evaluation has. */
enum { POWER_INPUT = MCT_EFFECT_COUNT, POWER_RESISTANCE, POWER_CONVERSION, POWER_FRAME, POWER_COUNT };

/* At a state [W], or the works of a run [J]. */
typedef struct {
    double of[POWER_COUNT];
} powers;

static inline double energy_total(energies self)
{
    return self.kinetic + self.potential + self.magnetic;
}

/* What a power brings to each energy: a motor takes from its magnetic energy, a weight from the potential one. */
static inline energies power_gains(int power, double amount, uint32_t effects)
{
    const uint32_t mask = power < MCT_EFFECT_COUNT ? mct_effects[power].mask : 0;
    const bool has_motor = (effects & MCT_MOTOR) != 0;
    if (power == POWER_RESISTANCE || power == POWER_CONVERSION || (power == POWER_INPUT && has_motor)) {
        return (energies){.magnetic = amount};
    }
    return (energies){amount, (mask & MCT_POTENTIAL) ? -amount : 0, (mask & MCT_MOTOR) ? -amount : 0};
}

/* What all of them bring. */
static inline energies powers_gains(const powers *self, uint32_t effects)
{
    energies sum = {0, 0, 0};
    for (int i = 0; i < POWER_COUNT; i++) {
        const energies gain = power_gains(i, self->of[i], effects);
        sum.kinetic += gain.kinetic;
        sum.potential += gain.potential;
        sum.magnetic += gain.magnetic;
    }
    return sum;
}

#endif
