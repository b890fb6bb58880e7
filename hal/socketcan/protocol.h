/**
 * @file protocol.h
 * What a drive understands and what it says. One const struct for each protocol, with both ends of it: the host's
 * (who controls) and the drive's (who is simulated by drive.h).
 *
 * Payloads are packed and unpacked by C generated from the DBC files beside; a protocol adds what a DBC cannot say:
 * identifiers by node, clamping, numbers that are not finite, order, unwrapping, arming.
 *
 * Nothing here allocates, waits or knows an operating system. Each function costs well below 1 us.
 */
#ifndef MCTAU_HAL_SOCKETCAN_PROTOCOL_H
#define MCTAU_HAL_SOCKETCAN_PROTOCOL_H

#include "hal/socketcan/counts.h"
#include "hal/socketcan/frame.h"
#include "mctau/real.h"
#include "mctau/scene.h"

#define MCT_CAN_MAX_MESSAGES 16 /**< of a protocol */
#define MCT_CAN_MAX_BURST    4  /**< frames that a request for readiness or a stop takes */
#define MCT_CAN_ENCODERS     2  /**< that one drive can read */

/** Which axes a message belongs to. */
enum {
    MCT_CAN_OF_MOTOR = 1 << 0,   /**< the drive that powers the motor */
    MCT_CAN_OF_ENCODER = 1 << 1, /**< a drive whose own encoder is read, with or without a motor */
    MCT_CAN_OF_SPARE = 1 << 2,   /**< a drive whose second encoder is read */
    MCT_CAN_OF_TORQUE = 1 << 3   /**< the drive that powers the motor, where it is told a torque */
};

/** One kind of frame. */
typedef struct {
    const char *name; /**< as in the DBC */
    uint32_t code;    /**< with the node it makes the identifier, see mct_can_protocol.identifier */
    uint8_t length;   /**< of a valid frame [bytes] */
    bool from_drive;  /**< the host hears it; what both ends hear has two lines */
    uint32_t of;      /**< MCT_CAN_OF_...: axes that cannot do without it; 0: never asked for */
    double period;    /**< [s] 0: each tick; negative: when something happens, not cyclic */
    double slowest;   /**< [s] a longer period stops the self-check; 0: three ticks; negative: not cyclic */
} mct_can_message;

/** The motor as its drive has to know it. Turns are those of the drive's own encoder. */
typedef struct {
    double supply;            /**< nominal [V] */
    double resistance;        /**< of the armature [ohm] */
    double torque_per_ampere; /**< at the drive's encoder [N m/A] */
    double emf_per_turn;      /**< back-emf by the speed of the drive's encoder [V s/turn] */
    bool inverted;            /**< positive volts turn it the other way */
} mct_can_motor;

/** What is known of a drive's state. */
typedef enum {
    MCT_CAN_DRIVE_UNKNOWN, /**< nothing heard yet, or not since it was asked to get ready */
    MCT_CAN_DRIVE_IDLE,    /**< well, but not driving */
    MCT_CAN_DRIVE_READY,   /**< obeys commands */
    MCT_CAN_DRIVE_FAULTY   /**< reports an error */
} mct_can_drive_state;

/** An encoder behind a drive, as the host follows it. */
typedef struct {
    bool used;
    int coordinate; /**< that it measures */
    double
        counts_per_turn; /**< of the drive's encoder, in the scene's counts; negative: mounted the other way */
    int32_t counts;      /**< newest; wraps at 32 bits */
    uint32_t updates;    /**< changes with each feedback that was new */
    int64_t time_us;     /**< when that came */
    uint8_t echo;        /**< sequence number of the newest command that the drive knew of, if it says so */
    uint16_t capture_us; /**< native: the drive's own clock at that feedback */
    int64_t steps;       /**< vesc: unwrapped position [0.02 deg] */
    double turns;        /**< odrive: position, finer than its float [turns] */
    double fastest;      /**< odrive 0.5: highest speed of late, by its counts [turns/s] */
    uint8_t last[8];     /**< payload of the last feedback, to tell one that is repeated */
} mct_can_encoder;

/** A drive as the host knows it. Zero-initialise, set the first block, then call mct_can_protocol functions. */
typedef struct {
    const struct mct_can_protocol *protocol;
    const mct_scene *scene; /**< its [can] settings; must outlive the axis */
    uint8_t node;
    uint32_t roles;      /**< MCT_CAN_OF_... */
    uint8_t watchdog_ms; /**< native: told with each command, mct_can_watchdog_ms */
    mct_can_motor motor;
    mct_can_encoder encoders[MCT_CAN_ENCODERS]; /**< its own, and a second one */

    uint8_t sequence;          /**< of the last command */
    mct_can_drive_state state; /**< by its newest message about itself */
    uint32_t state_updates;    /**< changes with each such message */
    uint32_t error;            /**< code of the drive, 0 none */
    bool watchdog_expired;     /**< the drive says that its watchdog stopped the motor */
    bool estopped;             /**< the drive says that an emergency stop holds it */
    uint32_t restarts;         /**< counts what looked like a restart of the drive */
    uint8_t axis_state;        /**< odrive: of its newest heartbeat; kept while it is asked to get ready */
    double bus_voltage;        /**< vesc, odrive: see mct_can_bus_voltage */
    uint16_t bus_10mv;         /**< native: likewise, as told [10 mV] */
    double rate;               /**< of the drive's encoder, as it says [turns/s]; 0: not heard */
    int64_t rate_us;           /**< odrive: when that came */
    double change;             /**< vesc, odrive: of the position, from message to message [turns] */
    uint32_t alternations;     /**< vesc, odrive: there and back, as two drives with one number answer */
    uint16_t serial;           /**< native: of the drive; 0: not heard */
    uint32_t serial_changes;   /**< native: another serial number under the same node */
    int32_t sent_duty;         /**< vesc: of the last command [1e-5] */
    uint32_t steady_commands;  /**< vesc: in a row, of one sign and large enough to be seen */
    bool has_moved;            /**< vesc: the position has changed since the last status */
    bool is_frozen;            /**< vesc: it tells a speed and does not change its position */
} mct_can_axis;

/** What a frame was. */
typedef enum {
    MCT_CAN_IS_FEEDBACK, /**< a position, new */
    MCT_CAN_IS_STATE,    /**< news of the drive itself */
    MCT_CAN_IS_STOP,     /**< somebody has called an emergency stop */
    MCT_CAN_IS_COMMAND,  /**< drive's end: a voltage, duty or torque to follow; the watchdog is fed */
    MCT_CAN_IS_REQUEST,  /**< drive's end: anything else to obey */
    MCT_CAN_IS_FOREIGN,  /**< of another node or kind */
    /* refused: nothing in the axis has changed */
    MCT_CAN_IS_REPEATED,
    MCT_CAN_IS_OLDER,
    MCT_CAN_IS_BAD_LENGTH,
    MCT_CAN_IS_BAD_FORMAT,
    MCT_CAN_IS_REMOTE,
    MCT_CAN_IS_NOT_FINITE,
    MCT_CAN_IS_BAD_CHECKSUM
} mct_can_verdict;

/** What a drive follows. */
typedef enum {
    MCT_CAN_WISH_RELEASE, /**< no current */
    MCT_CAN_WISH_VOLTS,   /**< [V] */
    MCT_CAN_WISH_DUTY,    /**< fraction of the supply */
    MCT_CAN_WISH_CURRENT, /**< [A] */
    MCT_CAN_WISH_TORQUE   /**< of the motor's shaft [N m] */
} mct_can_wish;

/** A drive from within: its end of the protocol. Zero-initialise, set the first block. */
typedef struct {
    const struct mct_can_protocol *protocol;
    const mct_scene *scene;
    uint8_t node;
    uint32_t roles;
    uint16_t serial;

    /* heard, by `obey` */
    bool wants_ready;      /**< asked to drive (closed loop, enabled) */
    bool wants_clear;      /**< asked to forget its errors; cleared by the drive when done */
    bool wants_stop;       /**< emergency stop; cleared by the drive when done */
    mct_can_wish wish;     /**< of the last command accepted */
    double value;          /**< in the wish's unit; always finite */
    uint8_t sequence;      /**< native: of the last command accepted */
    bool has_sequence;     /**< native: there was one */
    uint32_t watchdog_ms;  /**< native: asked for by the last command accepted; 0: none */
    uint32_t commands;     /**< accepted */
    uint32_t old_commands; /**< refused because their sequence number was not newer */

    /* to be reported, set by the drive before `report` */
    mct_can_drive_state state;
    uint32_t error;
    bool watchdog_expired, estopped, restarted, encoder_invalid;
    bool has_driven;                  /**< odrive 0.5: it has been ready since it started */
    int32_t counts[MCT_CAN_ENCODERS]; /**< native, odrive 0.5 */
    int32_t counts_per_turn;          /**< odrive 0.5: of its own encoder; 0: not known */
    double turns, rate;               /**< of its own encoder [turns], [turns/s] */
    double volts, amperes, supply;    /**< at the motor, at the motor, of the supply */
    double temperature;               /**< [degree Celsius] */
    uint64_t time_us;
} mct_can_device;

typedef struct mct_can_protocol {
    const char *name; /**< as in can.protocol */
    const char *doc;
    bool extended;  /**< identifiers have 29 bits */
    bool has_spare; /**< a drive can read a second encoder */
    bool has_echo;  /**< feedback tells which command it knew */
    bool has_state; /**< a drive tells whether it is ready */
    int message_count;
    const mct_can_message *messages;
    /** Identifier of a message to or from a node. */
    uint32_t (*identifier)(uint32_t code, uint8_t node);

    /* --- the host's end --- */

    /** Takes in a frame; `frame->time_us` becomes the time of what it tells. */
    mct_can_verdict (*hear)(mct_can_axis *axis, const mct_can_frame *frame);
    /**
     * The next command, clamped to what the frame can carry, rounded to its resolution. A voltage that is not finite
     * is sent as zero, disabled.
     * @param enable  false: zero volts whatever `volts` is
     */
    void (*command)(mct_can_axis *axis, mct_real volts, bool enable, mct_can_frame *frame);
    /** Frames that clear errors and make the drive ready; the number of them, 0 where it always is. */
    int (*arm)(mct_can_axis *axis, mct_can_frame frames[MCT_CAN_MAX_BURST]);
    /** Frames that bring the motor to zero volts at once and keep it there. */
    int (*stop)(mct_can_axis *axis, mct_can_frame frames[MCT_CAN_MAX_BURST]);

    /* --- the drive's end --- */

    /** Takes in a frame that came over the bus. */
    mct_can_verdict (*obey)(mct_can_device *device, const mct_can_frame *frame);
    /** Fills message number `message` (from_drive) of the table; false when the device has none to send. */
    bool (*report)(mct_can_device *device, int message, mct_can_frame *frame);
} mct_can_protocol;

#define MCT_CAN_PROTOCOL_COUNT 3
/** In the order of the choices of can.protocol, each in its newest form: for its name. */
extern const mct_can_protocol *const mct_can_protocols[MCT_CAN_PROTOCOL_COUNT];

/** What the drives of a scene speak, by can.protocol and can.firmware. */
const mct_can_protocol *mct_can_protocol_of(const mct_scene *scene);

extern const mct_can_protocol mct_can_native;
extern const mct_can_protocol mct_can_vesc;
extern const mct_can_protocol mct_can_odrive;     /**< firmware 0.6 */
extern const mct_can_protocol mct_can_odrive_0_5; /**< the same but for what its positions come from */

/** The supply as the drive measures it [V]; 0: not heard. */
double mct_can_bus_voltage(const mct_can_axis *axis);

/** can.watchdog as a native drive is told it: 5 to 255 ms, or 0 for none. */
uint8_t mct_can_watchdog_ms(double seconds);

/** Longest and nominal length of a frame on the wire, stuffing and the gap behind it included [bits]. */
int mct_can_nominal_bits(bool extended, int length);
int mct_can_stuffed_bits(bool extended, int length);

#endif
