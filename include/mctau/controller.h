/**
 * @file controller.h
 * Swing up by energy, catch, balance by LQR. Everything is computed at init from the scene's own model, so a
 * changed parameter needs no re-tuning.
 *
 * Balance: u = -K x with K from the discrete algebraic Riccati equation of the linearised model, sampled at
 *   the tick. The weights of a scene are deviations that cost as much as the full input.
 * Catch: the model has one unstable mode. Its amplitude z = w'x (w the left eigenvector) obeys z+ = lambda z
 *   + w'B u, so a bounded input can hold it if and only if |z| < |w'B| u_max / (lambda - 1): exactly the
 *   region from which the upright can be caught. Balancing takes over where |z| is below the scene's fraction
 *   `capture` of it, and gives up beyond it.
 * Swing up: the input drives the energy of the hanging part to that of the upright rest, fading out within
 *   `energy_band`. On a cart it sets the cart's acceleration, which also keeps the cart near the middle of
 *   its track.
 * Source: Astroem, Furuta, "Swinging up a pendulum by energy control", Automatica 36 (2000); Block, Astroem,
 *   Spong, "The reaction wheel pendulum" (2007).
 */
#ifndef MCTAU_CONTROLLER_H
#define MCTAU_CONTROLLER_H

#include "mctau/constants.h"
#include "mctau/message.h"
#include "mctau/observer.h"
#include "mctau/scene.h"

typedef enum {
    MCT_MODE_OPEN_LOOP, /**< no controller */
    MCT_MODE_WAIT,      /**< no valid reading so far */
    MCT_MODE_SWING_UP,
    MCT_MODE_BALANCE,
    MCT_MODE_STOPPED, /**< a fault is latched: zero volts, whatever is wanted */
    MCT_MODE_COUNT
} mct_mode;

/** Name of a mode, as telemetry shows it. */
const char *mct_mode_name(mct_mode mode);

typedef struct mct_controller {
    const mct_system *system;
    mct_real (*swing_up)(struct mct_controller *self); /**< law of the system [V] */
    uint32_t effects;
    mct_mode mode;
    mct_real limit;                          /**< largest input [V] */
    mct_real gains[2 * MCT_MAX_ENCODERS];    /**< K */
    mct_real travelled[MCT_MAX_ENCODERS];    /**< of a cyclic coordinate since balancing began */
    mct_real unstable[2 * MCT_MAX_ENCODERS]; /**< w, scaled: |w'x| < 1 is what can be caught */
    mct_real capture;
    mct_real energy_scale;       /**< 1 / (band * energy from hanging to upright) [1/J] */
    mct_real energy_shift;       /**< learned: added to the energy aimed at [J] */
    mct_real largest_shift;      /**< [J] */
    mct_real last_angle;         /**< of the pendulum at the last tick [rad] */
    mct_real information;        /**< of the samples that the observer's excess was learned from */
    mct_real memory;             /**< bound of information: old samples fade */
    mct_real direction;          /**< of pumping, +1 or -1 */
    mct_real still;              /**< rate below which the direction is kept [rad/s] */
    mct_real swing_acceleration; /**< of a cart [m/s^2] */
    mct_real track_stiffness;    /**< brings a cart home while it swings up [1/s^2] */
    mct_real track_damping;      /**< [1/s] */
    mct_real track_half_length;  /**< [m] */
    mct_observer observer;
    const mct_constants *constants; /**< of the model; caller-owned */
} mct_controller;

/**
 * Computes gains, catch region and pumping from the scene's model.
 * @param constants  written: those of the model; must outlive the controller, and is not changed afterwards
 * @return MCT_OK; MCT_ERROR_NO_CONVERGENCE when the model cannot be stabilised (no motor torque, say), with a
 * sentence in `why`
 */
mct_status mct_controller_init(mct_controller *controller, mct_constants *constants, const mct_scene *scene,
                               mct_message *why);

/**
 * One tick: takes in a reading, returns the wanted input [V]; the supervisor decides what gets through.
 * @param applied  input applied since the last tick [V]
 * Cost: observer + some 20 ns. Not thread-safe per controller.
 */
mct_real mct_controller_update(mct_controller *controller, const mct_reading *reading, mct_real applied);

/** Begins anew from the scene's initial position, at rest: what a drive that has restarted calls for. */
void mct_controller_restart(mct_controller *controller);

/** How well a region can be caught: |z|, 1 at its edge. */
mct_real mct_controller_reach(const mct_controller *controller);

#endif
