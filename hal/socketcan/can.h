/**
 * @file can.h
 * The HAL over a CAN bus: volts out, encoder counts in, through any transport and any protocol.
 *
 * Start: computes the bus load, listens until every drive has said all that is needed, and says what is missing or
 * too slow; arms the drives; sees that their watchdog acts where they tell. Then each tick: everything that has come
 * is drained and the newest kept; one command goes out, and one that the bus does not take at once is given up. On
 * any doubt the reading says so, and the supervisor cuts the voltage. After a stop, zero volts go out until arm.
 *
 * Clock: CLOCK_MONOTONIC, or in lockstep the drives' answers, with a bounded wait.
 */
#ifndef MCTAU_HAL_SOCKETCAN_CAN_H
#define MCTAU_HAL_SOCKETCAN_CAN_H

#include "hal/clock.h"
#include "hal/hal.h"
#include "hal/socketcan/axes.h"
#include "hal/socketcan/transport.h"

/** A message of a drive, as the start found it. */
typedef struct {
    const mct_can_message *message;
    uint8_t node;
    uint32_t id;
    uint64_t count;            /**< received while listening */
    int64_t first_us, last_us; /**< of them */
    double period;             /**< mean [s]; 0: fewer than two came */
    double slowest;            /**< allowed [s] */
} mct_can_heard;

#define MCT_CAN_MAX_HEARD (MCT_CAN_MAX_AXES * MCT_CAN_MAX_MESSAGES)

/** What the start found. */
typedef struct mct_can_report {
    double nominal_load; /**< fraction of the bus, no stuff bits */
    double load;         /**< with as many stuff bits as there can be */
    int heard_count;
    mct_can_heard heard[MCT_CAN_MAX_HEARD];
    bool watchdog_tells;    /**< the protocol shows whether a watchdog has acted */
    bool watchdog_verified; /**< it was seen to act */
    double bus_voltage;     /**< as the motor's drive measures it [V]; 0: not heard */
} mct_can_report;

typedef struct {
    mct_can_transport transport;
    const mct_scene *scene;
    const mct_state *plant; /**< of a simulated drive in the same process, else NULL */
    bool lockstep;
    double dt;
    uint32_t tick_us;
    int encoder_count;
    mct_can_axes axes;
    /* what was heard */
    mct_reading reading;                   /**< last given */
    uint32_t updates[MCT_MAX_ENCODERS];    /**< of each encoder, as last read */
    uint64_t fresh_tick[MCT_MAX_ENCODERS]; /**< tick at which each encoder last had something new */
    uint32_t restarts[MCT_CAN_MAX_AXES];   /**< of each drive, as last read */
    bool invalid, estop;                   /**< heard since the last read */
    mct_can_link_state link;
    /* what is sent */
    uint64_t tick;
    bool stopped;          /**< zero volts until arm */
    uint32_t arming_ticks; /**< left for the drives to get ready */
    bool arming_failed;    /**< they did not */
    int64_t sent_us[256];  /**< when the command of each sequence number went out */
    uint8_t answered;      /**< sequence number of the newest command that was answered */
    mct_clock clock;
    mct_can_counts counts;
    mct_can_report report;
} mct_can;

/**
 * Prepares the HAL; opens nothing.
 * @param scene      must outlive `can`
 * @param transport  likewise
 * @param lockstep   paced by the drives' answers instead of the clock
 * @return MCT_OK, or what mct_can_axes_init says; MCT_ERROR_RANGE for a bus load above can.highest_load
 */
mct_status mct_can_init(mct_can *can, const mct_scene *scene, mct_can_transport transport, bool lockstep,
                        mct_message *why);

/** The HAL; `can` must outlive it. Its open may take some seconds. */
mct_hal mct_can_hal(mct_can *can);

#endif
