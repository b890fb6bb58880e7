/**
 * @file system.h
 * What a system is: a descriptor (names, units, ranges, defaults) and its closed form M(q) a + C(q,v) v =
 *   tau.
 *
 * Conventions: SI units, radians; axes 1 right, 2 up, 3 to the viewer. States are ordered coordinates q,
 * rates v, then the motor's current [A] when the motor is inductive. The input is a voltage [V] with a motor,
 * else a force [N] or torque [N m].
 */
#ifndef MCTAU_SYSTEM_H
#define MCTAU_SYSTEM_H

#include "mctau/effects.h"
#include "mctau/field.h"
#include "mctau/hyperdual.h"
#include "mctau/motor.h"
#include "mctau/real.h"
#include "mctau/status.h"

#define MCT_MAX_COORDINATES 16 /**< of a chain, which has no rates; 6 of a system with rates */
#define MCT_MAX_STATES      16 /**< of a chain; 13 of a rigid body */
#define MCT_MAX_ENCODERS    2  /**< coordinates of a system with a motor */
#define MCT_MAX_PARAMETERS  24
#define MCT_MAX_PARTICLES   32 /**< as many as the Gauss engine takes */
#define MCT_MAX_LISTS       2  /**< of rows, among a system's parameters */

#define MCT_PHASES          2 /**< of a prescribed motion: one an axis */

struct mct_scene;
struct mct_message;

/** Everything that the equation of motion says at one state. Filled by mct_system.evaluate. */
typedef struct {
    /* of position */
    mct_real M[MCT_MAX_COORDINATES][MCT_MAX_COORDINATES]; /**< mass matrix, symmetric positive definite */
    mct_real position[MCT_MAX_PARTICLES][3];              /**< of each particle [m] */
    mct_real mass[MCT_MAX_PARTICLES];                     /**< [kg] */
    mct_real potential_energy; /**< of MCT_POTENTIAL, gravity's zero at the height of the pivot [J] */
    /* of position and velocity */
    mct_real C[MCT_MAX_COORDINATES][MCT_MAX_COORDINATES]; /**< m J' Jdot; only C v is unique */
    mct_real Cv[MCT_MAX_COORDINATES];
    mct_real kinetic_energy;  /**< [J] */
    mct_real magnetic_energy; /**< L i^2 / 2 of an inductive motor [J] */
    /* of position, velocity and input */
    mct_real tau[MCT_MAX_COORDINATES];               /**< everything applied, per coordinate */
    mct_real acceleration[MCT_MAX_COORDINATES];      /**< M^-1 (tau - C v) */
    mct_real current;                                /**< of the motor [A] */
    mct_real force[MCT_MAX_PARTICLES][3];            /**< f on each particle from outside [N] */
    mct_real constraint_force[MCT_MAX_PARTICLES][3]; /**< e = m xdd - f [N] */
    /*
     * Powers [W]. Kinetic energy changes by the sum of power[], power_frame and, without a motor, power_input. The motor
     * takes power_input in: + power_resistance + power_conversion - power[MCT_EFFECT_MOTOR] is the rate of its magnetic
     * energy.
     */
    mct_real power
        [MCT_EFFECT_COUNT]; /**< that each effect brings into kinetic energy; 0 of one that is off. At most 0
                                           of viscous, stokes and drag, and of coulomb unless a belt drives */
    mct_real power_input;   /**< of the force or torque, or V i of the motor's terminals */
    mct_real power_resistance; /**< - R i^2 */
    mct_real power_conversion; /**< (k_T - k_b) i w: 0 where the motor's constants agree */
    mct_real
        power_frame; /**< of a rotating frame: what its apparent forces, which are booked as they work in the
                               frame, do not do in space */
} mct_evaluation;

/**
 * The system about its upright rest, x = (q, v), with the motor's current eliminated (L = 0): xdot = A x + B
 * input.
 */
typedef struct {
    int states;                                                /**< 2 n */
    double A[(2 * MCT_MAX_ENCODERS) * (2 * MCT_MAX_ENCODERS)]; /**< row-major, states x states */
    double B[2 * MCT_MAX_ENCODERS];
} mct_linear_model;

/**
 * A rotation among the coordinates: its position is a unit quaternion of four entries (w, x, y, z: body to space), its
 * rate an angular velocity of three. It is the last three coordinates.
 */
typedef enum {
    MCT_ATTITUDE_NONE,
    MCT_ATTITUDE_SPACE, /**< the angular velocity is along the axes of space */
    MCT_ATTITUDE_BODY   /**< along those of the body */
} mct_attitude;

/**
 * A list among the parameters, a row for each of its items: particles = [[0.1, 0, -0.3], [0.2, 0.1, 0]]. With one
 * column a row is a number: link_lengths = [0.3, 0.2].
 */
typedef struct {
    const char *name;
    const char *doc;
    uint32_t effects; /**< while none of them is on, nothing reads the list; 0: read always */
    int column_count;
    const mct_field *columns; /**< what the numbers of a row are; a choice is given by its name */
    int fewest_rows;
    int most_rows;
    int standard_rows; /**< those of a scene that does not say */
    const double *standard;
} mct_row_list;

/**
 * State of a simulated system. The exact value of entry i is x[i] + c[i], plus turns[i] whole turns of an
 * angle.
 */
typedef struct {
    mct_real x[MCT_MAX_STATES];         /**< value, rounded; angles stay within +-2 pi */
    mct_real c[MCT_MAX_STATES];         /**< what rounding has kept back: compensated summation */
    int32_t turns[MCT_MAX_COORDINATES]; /**< whole turns taken out of an angle */
} mct_state;

/**
 * Advances a state by `steps` steps under a held input. One kernel is one system x stepper x effect set.
 * Bounded work, no branches on effects; reads the constants only.
 */
typedef void (*mct_kernel)(const void *constants, mct_state *state, mct_real input, int32_t steps);

/** A kernel and the symbol that a program finds it by, mct_SYSTEM_STEPPER_SET. */
typedef struct {
    mct_kernel function;
    const char *name;
} mct_named_kernel;

#define MCT_MOTION_STATES 5  /**< of a system whose motion can be had as a series */
#define MCT_MOTION_TERMS  13 /**< of order 13 in coordinates, 12 in the other states */

/** The motion over one step: after the part f of it, state i has changed by the sum of term[n][i] f^(n+1). */
typedef struct {
    mct_real term[MCT_MOTION_TERMS][MCT_MOTION_STATES]; /**< 0 behind the states */
    mct_real remainder; /**< what rounding the step's length leaves out of each change, relative to it */
} mct_motion;

/** A coordinate: what scenes and telemetry call it, and how an encoder sees it. */
typedef struct {
    mct_field position;
    mct_field rate;
    bool is_angle;           /**< kept within a turn; its encoder counts per turn, else per metre */
    bool is_cyclic;          /**< no force depends on it: not brought home by a controller */
    mct_field encoder;       /**< counts per turn or metre, a key of [sensors] */
    mct_field encoder_node;  /**< drive that reads it, a key of [can] */
    mct_field encoder_ratio; /**< turns of the drive's encoder per turn or metre, a key of [can] */
    double position_weight;  /**< default deviation that costs a controller as much as the full input */
    double rate_weight;
} mct_coordinate;

/** The three keys of an encoder, as MCT_ENCODER("arm", "turn", "1/turn", 4, 4096, "the arm"). */
#define MCT_ENCODER(name, per, unit, fewest, standard, what)                          \
    .encoder = {name "_counts_per_" per,                                              \
                unit,                                                                 \
                "encoder of " what,                                                   \
                MCT_FIELD_REAL,                                                       \
                fewest,                                                               \
                1e9,                                                                  \
                standard,                                                             \
                NULL,                                                                 \
                0,                                                                    \
                0},                                                                   \
    .encoder_node = {name "_node",                                                    \
                     "",                                                              \
                     "drive that reads the encoder of " what                          \
                     "; -1: the motor's where it can, else the next number",          \
                     MCT_FIELD_INTEGER,                                               \
                     -1,                                                              \
                     63,                                                              \
                     -1,                                                              \
                     NULL,                                                            \
                     0,                                                               \
                     0},                                                              \
    .encoder_ratio = MCT_QUANTITY(name "_ratio", "", -1e4, 1e4, 1,                    \
                                  "turns of the drive's encoder per " per " of " what \
                                  "; negative: mounted the other way round")

/** What a controller and hardware have to know of a system with a motor. Each of its coordinates has an encoder. */
typedef struct {
    int driven_coordinate;       /**< the one that the motor acts on */
    int upright_coordinate;      /**< the angle that is zero upright */
    int supply_parameter;        /**< index of the supply voltage [V] */
    int current_limit_parameter; /**< of the drive [A] */
    int resistance_parameter;    /**< of the motor's armature [ohm] */
    int inductance_parameter;    /**< of the motor's armature [H] */
    /**
     * Accelerations alone, for observers; coulomb is ignored, the motor taken as quasi-static unless off. s, c: sine and
     * cosine of the upright coordinate in x.
     */
    void (*accelerate)(const void *constants, uint32_t effects, const mct_real *x, mct_real s, mct_real c,
                       mct_real input, mct_real *a);
    void (*linearise)(const struct mct_scene *scene, mct_linear_model *model);
    /** The motor among the constants. */
    const mct_motor *(*motor)(const void *constants);
} mct_actuation;

typedef struct mct_system {
    const char *name;
    const char *doc;
    const char *source;   /**< section of the source document */
    int coordinate_count; /**< n; the most of a system whose coordinates are listed */
    const mct_coordinate *coordinates;
    mct_attitude attitude;  /**< whether the last three coordinates are a rotation */
    bool lists_coordinates; /**< one for each row of the first list: see mct_coordinate_count() */
    bool is_process;        /**< coordinates alone, without rates: they change by steps of their own */
    int parameter_count;
    const mct_field *parameters; /**< a choice is stored as its index */
    int list_count;
    const mct_row_list *lists; /**< further keys of [parameters] */
    /**
     * MCT_PHASES states that grow at constant rates while one of MCT_CLOCK is on: the clock of what is prescribed. Those
     * in rad are angles and lose whole turns.
     * States behind the rates, no coordinates. NULL without; a system with phases has no motor.
     */
    const mct_field *phases;
    bool is_timed;                        /**< its kernels keep the time behind the states */
    const mct_field *input_without_motor; /**< name and unit of the input when the motor is off */
    uint32_t effects;                     /**< those that it supports */
    uint32_t standard_effects;            /**< those that are on when a scene does not say */
    int particle_count;                   /**< without a list of them */
    const char *const *particle_names;
    bool
        lists_particles; /**< one for each row of the first list, if there are any: see mct_particle_count() */
    const mct_actuation *actuation; /**< NULL for a system without a motor */

    /**
     * Checks a scene's parameters against each other and computes all constants, in double, for steps of h
     * seconds.
     */
    mct_status (*prepare)(const struct mct_scene *scene, double h, void *constants, struct mct_message *why);
    /** M, C, tau, accelerations, constraint forces, energies and powers at x. */
    void (*evaluate)(const void *constants, uint32_t effects, const mct_real *x, mct_real input,
                     mct_evaluation *out);
    /**
     * The geometry x = h(q) for the generic Gauss engine: an mct_gauss_place whose context is `constants`, but q holds a
     * rotation as its quaternion. mct_judge() is the way to it.
     */
    void (*place)(const void *constants, mct_hyperdual time, const mct_hyperdual *q,
                  mct_hyperdual (*position)[3]);
    /** Kernels by stepper and kernel mask; NULL where the pair does not fit. */
    const mct_named_kernel *(*kernel)(int stepper, uint32_t effects);
    /** Writes the motion over one step of `taylor12`; NULL where its series is not at hand. For scene.stride. */
    void (*motion)(const void *constants, uint32_t effects, const mct_state *state, mct_real input,
                   mct_motion *motion);
} mct_system;

#define MCT_SYSTEM_COUNT 15
/** All systems, in the order in which they are listed. */
extern const mct_system *const mct_systems[MCT_SYSTEM_COUNT];

/**
 * The effects as they are simulated: a motor that is called inductive but has no inductance is the
 * quasi-static one, which is its limit.
 */
uint32_t mct_scene_effects(const struct mct_scene *scene);

/** Number of encoders: those of a system with a motor. */
int mct_encoder_count(const mct_system *system);

/** Number of coordinates n of a scene's system. */
int mct_coordinate_count(const struct mct_scene *scene);

/** Number of particles of a scene's system. */
int mct_particle_count(const struct mct_scene *scene);

/** Place of the first rate in a system's state: n, and one more with a rotation. Not of a process. */
int mct_rate_index(const mct_system *system);

/** Number of states of a scene's system: positions, rates, the current of an inductive motor or the phases. */
int mct_state_count(const struct mct_scene *scene);

/** The most states that a system may have, with any effects. */
int mct_most_states(const mct_system *system);

/** Whether state `index` is a phase. */
bool mct_state_is_phase(const mct_system *system, int index);

/** Whether state `index` is a phase that is an angle, in rad: it loses whole turns. */
bool mct_state_is_phase_angle(const mct_system *system, int index);

/** Descriptor of state `index` (coordinates, rates, then current or phases): name and unit. */
const mct_field *mct_state_field(const mct_system *system, int index);

#endif
