/**
 * @file supervisor.h
 * The one gate between a wanted voltage and the motor: limits, arming, stale sensors, latched faults. Any
 * doubt ends at zero volts, with its reason named and counted; a latched fault stays until
 * mct_supervisor_rearm.
 */
#ifndef MCTAU_SUPERVISOR_H
#define MCTAU_SUPERVISOR_H

#include "hal/hal.h"
#include "mctau/scene.h"

typedef enum {
    MCT_FAULT_SENSOR_INVALID, /**< a sensor gave a value that is not finite */
    MCT_FAULT_SENSOR_STALE,   /**< no valid feedback for too long */
    MCT_FAULT_SENSOR_FROZEN,  /**< the motor was driven but its encoder did not move */
    MCT_FAULT_ESTIMATE,       /**< an estimate was not finite */
    MCT_FAULT_COMMAND,        /**< a wanted voltage was not finite */
    MCT_FAULT_TRACK_END,      /**< the cart left its track */
    MCT_FAULT_OVERSPEED,      /**< a rate beyond the scene's limit */
    MCT_FAULT_HAL,            /**< the HAL could not read or write */
    MCT_FAULT_STOPPED,        /**< stopped from outside */
    MCT_FAULT_LINK_DOWN,      /**< nothing could be sent to the motor */
    MCT_FAULT_NOT_READY,      /**< the motor's drive ceased to obey */
    MCT_FAULT_DRIVE,          /**< a drive reported an error */
    MCT_FAULT_RESTARTED,      /**< a drive restarted and forgot its position */
    MCT_FAULT_ESTOP,          /**< an emergency stop was called on the bus */
    MCT_FAULT_NO_BALANCE,     /**< driven for too long without balancing */
    MCT_FAULT_ENERGY,         /**< a simulation gained energy from nowhere: mct_watch_tick() */
    MCT_FAULT_COUNT
} mct_fault;

/** Name of a fault, as in telemetry and `faults` of a run's result. */
const char *mct_fault_name(mct_fault fault);

/** One sentence: what happened and what to look at. */
const char *mct_fault_text(mct_fault fault);

typedef struct {
    const mct_system *system;
    bool observed;                    /**< there are estimates to watch */
    bool armed;                       /**< a first valid reading has come, and no fault is latched */
    uint32_t latched;                 /**< bit (1 << fault) */
    uint64_t counts[MCT_FAULT_COUNT]; /**< ticks on which a fault was seen */
    uint64_t derated_ticks;           /**< voltage reduced because feedback was late */
    uint64_t limited_ticks;           /**< voltage cut at the limit */
    mct_real limit;                   /**< [V]; the largest finite number for a plain force */
    mct_real steps_per_volt;          /**< resolution of what is passed; 0: exact */
    mct_real watch_limit;             /**< input above which the encoder must move */
    uint32_t derate_us;               /**< age from which the voltage is reduced */
    uint32_t stale_us;                /**< age from which it is zero */
    uint32_t frozen_ticks;            /**< driven without motion so far */
    uint32_t frozen_limit;            /**< how many are too many */
    int32_t last_counts;              /**< of the driven coordinate */
    mct_real track_half_length;       /**< [m], of a driven length */
    mct_real overspeed;               /**< [rad/s] of the driven angle */
    uint32_t rearm_limit;    /**< ticks of good feedback after which a fault is forgotten; 0: never */
    uint32_t good_ticks;     /**< of good feedback since a fault was latched */
    uint64_t rearmed;        /**< times that faults were cleared */
    uint64_t give_up_limit;  /**< restless ticks that are too many; 0: any number will do */
    uint64_t restless_ticks; /**< of driving without balance, less those of balance since */
} mct_supervisor;

/** Voltages of a closed loop are whole millivolts: what a drive can be told, and the same in a simulation. */
#define MCT_STEPS_PER_VOLT 1000

void mct_supervisor_init(mct_supervisor *supervisor, const mct_scene *scene);

/**
 * Decides what reaches the motor.
 * @param reading   of this tick
 * @param estimate  coordinates and rates, or NULL in open loop
 * @param wanted    [V]
 * @return wanted, limited and rounded to the resolution, or 0. Always finite, never beyond the limit. Cost: some
 *         10 ns.
 */
mct_real mct_supervisor_pass(mct_supervisor *supervisor, const mct_reading *reading, const mct_real *estimate,
                             mct_real wanted);

/**
 * Says on each tick of a closed loop, ahead of mct_supervisor_pass, whether the controller balances. One that has driven
 * without balance for mct_scene.give_up_after longer than with it will not: the motor is too weak, an encoder too coarse.
 * It would swing at full voltage for ever.
 */
void mct_supervisor_watch_balance(mct_supervisor *supervisor, bool is_balancing);

/** Latches a fault that somebody else saw. */
void mct_supervisor_fault(mct_supervisor *supervisor, mct_fault fault);

/**
 * Whether feedback has been good for as long as the scene asks for (controller.rearm_after) since a fault was
 * latched; asks once for each time.
 */
bool mct_supervisor_wants_rearm(const mct_supervisor *supervisor);

/**
 * Clears latched faults. The motor is driven again from the next reading on that is well and says that the drive is
 * ready; a cause that persists latches again.
 */
void mct_supervisor_rearm(mct_supervisor *supervisor);

#endif
