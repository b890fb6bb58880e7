/**
 * @file drive.h
 * The virtual drive: a scene's plant behind the drives of a protocol, with the limits that real ones have.
 *
 * It holds the plant and its sensors (hal/sim), answers on the bus as the drives of the scene's [can] would
 * (one device for each node), and keeps their rules: watchdog, voltage limits, resolution, a VESC's duty
 * ramp and its slower messages, readiness, emergency stop. The mechanism is held in its initial state until
 * the motor's drive is ready for the first time, or while `held`.
 *
 * A tick obeys what has come, steps the plant, senses, reports: over a bus that loses nothing, a controller
 * meets the same counts at the same ticks as with hal/sim, to the bit. A command of the controller's tick n
 * acts from state n to state n + 1.
 *
 * When nothing may drive the motor, a native drive's bridge puts zero volts on it (as hal/sim does); the
 * others let it run free: no current, the terminals follow the back-emf. After a reboot no bridge works
 * until the drive is up. A native drive has no watchdog but the one that it is told.
 *
 * Faults of [can] begin and end at ticks of the mechanism, so nothing befalls what is held; one of no
 * duration lasts one tick. They befall the frames of all drives:
 *
 *   drop, silence   no frame is sent; those that come are still heard
 *   short, remote   each frame lacks its last byte; is a remote request
 *   format          11 bits of identifier in place of 29, or the reverse
 *   duplicate       each frame comes twice
 *   delay           each frame comes MCT_CAN_DELAY ticks late; what is on its way at the end comes at once,
 *                   in order
 *   reorder         frames of each second tick come behind those of the next one
 *   drop_commands   volts, duty or torque that the host sends are not heard; requests and stops are
 *   nan             the encoder gives no valid counts: an ODrive sends NaN, a native drive says so; a VESC
 *                   and an ODrive 0.5, which have no words for it, do not send their position
 *   reboot          at the first tick all drives go dark for 50 ms, or the duration if that is longer: then
 *                   idle, clocks and counters at zero, nothing remembered
 *   estop           one emergency stop at the first tick, until it is cleared; a native drive says so on the
 *                   bus
 *   error           the motor's drive reports a fault of its power stage, which can be cleared once it is
 *                   over
 *
 * A VESC has no message for the last two: it lets the motor run free while they last. Over a socket a frame
 * that comes right behind one of the same identifier may be given up (socket.h), so that on a real bus
 * duplicates and what a delay has gathered may be lost.
 */
#ifndef MCTAU_HAL_SOCKETCAN_DRIVE_H
#define MCTAU_HAL_SOCKETCAN_DRIVE_H

#include "hal/sim/sim.h"
#include "hal/socketcan/axes.h"
#include "hal/socketcan/ring.h"
#include "hal/socketcan/transport.h"

#define MCT_CAN_DELAY 8 /**< ticks by which a frame is late while a delay lasts */
#define MCT_CAN_MAX_DELAYED \
    (MCT_CAN_DELAY * MCT_CAN_MAX_AXES * MCT_CAN_MAX_MESSAGES) /**< frames on their way */

/** What became of the virtual drive; times in ticks of the mechanism. */
typedef struct {
    uint64_t ticks;          /**< simulated since the release */
    uint64_t commands;       /**< accepted */
    uint64_t old_commands;   /**< refused: not newer than the last one */
    uint64_t refused;        /**< frames refused for their form */
    uint64_t watchdog_trips; /**< motor stopped because no command came */
    uint64_t stops;          /**< emergency stops obeyed */
    uint64_t driven_ticks;   /**< on which a bridge put volts other than zero on the motor */
    uint64_t last_driven;    /**< the last one of them */
    uint64_t spoilt;         /**< frames that a fault befell */
    double highest_volts;    /**< largest magnitude that a bridge put on the motor [V] */
} mct_can_drive_result;

/** What a drive keeps to itself; times in ticks since it went on the bus. */
typedef struct {
    uint64_t booted;                    /**< when its clock was zero */
    uint64_t dark_until;                /**< it reboots until then; 0: it works */
    uint64_t fed;                       /**< when the watchdog was last fed */
    double duty;                        /**< vesc: in use */
    int32_t sensed[MCT_CAN_ENCODERS];   /**< counters as last sensed */
    int64_t position[MCT_CAN_ENCODERS]; /**< counts since it started, not wrapped */
    double due[MCT_CAN_MAX_MESSAGES];   /**< when each message is sent next [s since it went on the bus] */
} mct_can_drive_board;

/** A frame on its way. */
typedef struct {
    mct_can_frame frame;
    uint64_t due; /**< [ticks since it went on the bus] */
} mct_can_late_frame;

typedef struct {
    mct_sim sim;
    mct_can_transport transport;
    const mct_scene *scene;
    bool lockstep; /**< the host paces the drive: a VESC's messages come each tick */
    bool held;     /**< by the owner: the mechanism does not move, the drives talk */
    bool released; /**< the motor's drive has been ready, or the owner has let go: the mechanism moves */
    bool powered;  /**< a bridge puts `volts` on the motor; else it runs free */
    double volts;  /**< presently at the motor, in the plant's sense [V] */
    mct_can_counts counts;
    mct_can_link_state link;
    mct_can_drive_result result;
    int device_count;
    mct_can_device devices[MCT_CAN_MAX_AXES];     /**< the first one powers the motor */
    mct_can_drive_board boards[MCT_CAN_MAX_AXES]; /**< of each device */
    mct_can_axes axes;                            /**< what belongs to which device */
    /* private */
    mct_can_ring *ring; /**< that it serves, or NULL */
    bool was_held, calls_stop;
    uint64_t tick;                                       /**< since it went on the bus */
    mct_reading reading;                                 /**< of the sensors, at the present state */
    double rates[MCT_MAX_LATENCY + 1][MCT_MAX_ENCODERS]; /**< as the sensors' queue [counts/s] */
    double rate[MCT_MAX_ENCODERS];                       /**< as last sensed [counts/s] */
    uint64_t fault_begin, fault_end;                     /**< [ticks of the mechanism] */
    int late_first, late_count;
    mct_can_late_frame late[MCT_CAN_MAX_DELAYED]; /**< a queue, in the order in which they were sent */
} mct_can_drive;

/**
 * Prepares a virtual drive; opens nothing.
 * @param scene      must outlive the drive
 * @param transport  of the bus; must outlive the drive
 * @return MCT_OK, or what mct_can_axes_init and mct_sim_init say
 */
mct_status mct_can_drive_init(mct_can_drive *drive, const mct_scene *scene, mct_can_transport transport,
                              mct_message *why);

/** Goes on the bus, without volts. */
mct_status mct_can_drive_open(mct_can_drive *drive, mct_message *why);

/** One tick: obeys what has come, keeps its rules, steps the plant unless it is held, says what is due. */
void mct_can_drive_tick(mct_can_drive *drive);

/**
 * Waits, at most `timeout_us`, until a command for the motor has come, whether or not it is obeyed; requests
 * are taken in meanwhile. For who ticks by commands instead of by a clock.
 * @return whether one has come
 */
bool mct_can_drive_wait(mct_can_drive *drive, int64_t timeout_us);

/** Zero volts and off the bus. */
void mct_can_drive_close(mct_can_drive *drive);

/**
 * Puts the drive behind end 1 of a ring, in lockstep: it ticks, and the ring's clock with it, whenever end 0
 * waits in vain. Its transport must be that end.
 */
void mct_can_drive_serve(mct_can_drive *drive, mct_can_ring *ring);

#endif
