/* The fast identifier for programs in C (C99): what shapeid/fast/identifier.hpp does.
 *
 * Create an identifier from files, feed it samples at the rate of the robot, and read the
 * parameters whenever a feed answers (docs/examples/identifier.c). No exception leaves a function.
 * shapeid_create() allocates; nothing else does, but for division of polyhedra, which
 * allocates whenever one is cut that was not cut the same way shortly before
 * (fast/part_tree.hpp; if memory is used up there, the program ends). Traps of floating-point must
 * be off: a division by zero may happen and be put right. An identifier is used by one thread at a
 * time; different identifiers do not know of each other.
 *
 * SI units and radians. A contact or link is told by its place in the robot's order, which the
 * ..._count and ..._name functions give; joints are in the order of shapeid_joint_name().
 *
 * Link against shapeid::fast; the linker is that of C++ (CMake: LANGUAGES C CXX). A program in C++
 * that has Eigen as well shares Eigen's functions with the library, and must align as it does
 * (README.md): include Eigen before this file, and the linker says so if it does not. */
#ifndef SHAPEID_FAST_SHAPEID_H
#define SHAPEID_FAST_SHAPEID_H

#include <stddef.h>

#if defined(__cplusplus) && (defined(EIGEN_CORE_H) || defined(EIGEN_CORE_MODULE_H))
#if __cplusplus >= 201103L
#include "shapeid/models/alignment.hpp"
#endif
#endif

#ifdef __cplusplus
extern "C" {
#endif

/** "0.1.0". */
const char* shapeid_version(void);

/** Made by shapeid_create(), ended by shapeid_destroy(). */
typedef struct shapeid_identifier shapeid_identifier;

typedef enum shapeid_root {
  SHAPEID_FLOATING_ROOT, /**< the URDF's root link moves freely */
  SHAPEID_FIXED_ROOT     /**< it stands upright and still: an arm */
} shapeid_root;

/** What becomes of contact forces. */
typedef enum shapeid_contacts {
  SHAPEID_PROJECT_CONTACTS, /**< unknown, eliminated by projection */
  /** Measured, part of every sample, whatever the flags say. Of a plane or a line the force alone
   * counts: moments that it transmits are taken for the links' own. */
  SHAPEID_MEASURED_CONTACTS,
  SHAPEID_IGNORE_CONTACTS /**< there are none */
} shapeid_contacts;

/** Start from shapeid_default_settings() and change what is to differ. */
typedef struct shapeid_settings {
  shapeid_root root;         /**< floating */
  shapeid_contacts contacts; /**< project */
  /** Diagonal of W, 1 / sigma^2 of each equation: base force (3), base moment (3) (floating root
   * only), then a number for each joint; positive, and within twelve decades of each other
   * (docs/derivations/projection.md). NULL (default): ones, whatever robot.yaml says of noise. Read
   * by shapeid_create() alone. Joints have the order of shapeid_joint_name(): ask an identifier
   * made without weights, or count on the URDF's. */
  const double* weight;
  size_t weight_count;  /**< numbers there: 6 + joints, or joints for a fixed root; 0 for NULL */
  size_t window;        /**< samples a window: 10 */
  size_t stride;        /**< samples from one window to the next: 10, at 500 Hz 20 ms */
  double alpha;         /**< of filter (17), in (0, 1]: 0.5; 1 does not smooth */
  double expected_mass; /**< kg, of all free links, 1e-6 to 1e6; 0 (default): from robot.yaml, else
                             the URDF */
  /** Density term, >= 0; negative (default): computed from each window until one has forces of a
   * thousandth of the weight of all links (drives are on), then kept. */
  double lambda;
  double mass_bound;     /**< kg, for the gap; 0 (default): ten times the expected mass */
  int most_divisions;    /**< in every window: 0 (default) divides nothing */
  double division_step;  /**< divisions end when a step is below this: 1e-3 */
  int division_patience; /**< ... this many times in a row: 3 */
} shapeid_settings;

/** Writes the defaults that stand above. Does nothing for NULL. */
void shapeid_default_settings(shapeid_settings* settings);

/** Reads the files and makes an identifier, or returns NULL and says in `error` why: one line that
 * names the file and what is wrong with it, cut off at `error_size` bytes and ended by a zero.
 *
 * robot_yaml: contacts, rotors, the IMU's pose (for shapeid_set_base()) and expected masses
 * (docs/formats/robot-yaml.md); NULL: nothing ever touches, and the IMU is the base frame.
 * shapes_yaml: which links are sought (docs/formats/shapes-yaml.md); NULL: the floating base, made
 * of its collision bodies. settings: NULL for the defaults. error: may be NULL. */
shapeid_identifier* shapeid_create(const char* urdf, const char* robot_yaml,
                                   const char* shapes_yaml, const shapeid_settings* settings,
                                   char* error, size_t error_size);

/** Frees it; names and numbers that it gave out end with it. Does nothing for NULL. */
void shapeid_destroy(shapeid_identifier* identifier);

/** Zero for NULL. */
size_t shapeid_joint_count(const shapeid_identifier* identifier);
size_t shapeid_contact_count(const shapeid_identifier* identifier);
/** Links that are sought. */
size_t shapeid_free_link_count(const shapeid_identifier* identifier);
/** Shapes of unknown mass, before any division. */
size_t shapeid_shape_count(const shapeid_identifier* identifier);

/** Names in the URDF, valid until shapeid_destroy(); NULL if there is no such place. */
const char* shapeid_joint_name(const shapeid_identifier* identifier, size_t place);
const char* shapeid_contact_name(const shapeid_identifier* identifier, size_t place);
const char* shapeid_free_link_name(const shapeid_identifier* identifier, size_t place);

/** One instant of the motion. Base quantities are in base-frame axes at the base link's origin
 * (shapeid_set_base() makes them of an IMU's); for a fixed root they are (0, 0, 0), (0, 0, 0) and
 * (0, 0, 9.81). Arrays are read during the call only. */
typedef struct shapeid_sample {
  double time;                         /**< s; handed through: after a gap, forget samples */
  double base_angular_velocity[3];     /**< rad/s, the gyro */
  double base_angular_acceleration[3]; /**< rad/s^2 */
  double base_specific_force[3];       /**< m/s^2, an accelerometer: (0, 0, 9.81) at rest */
  size_t joint_count;                  /**< numbers in q, dq, ddq and tau: all joints */
  const double* q;                     /**< rad or m */
  const double* dq;                    /**< rad/s or m/s */
  const double* ddq;                   /**< rad/s^2 or m/s^2 */
  /** Joint-side torques or forces, N m or N; what the rotors of robot_yaml take is taken off. */
  const double* tau;
  size_t contact_count;            /**< numbers in in_contact: all contacts */
  const unsigned char* in_contact; /**< not zero: it touches. NULL: nothing touches */
  /** Forces in base axes, N: x, y, z of contact 0, of contact 1, ...; NULL: not measured. */
  const double* contact_force;
} shapeid_sample;

typedef enum shapeid_status {
  SHAPEID_KEPT,     /**< no window is complete yet */
  SHAPEID_ANSWERED, /**< a window was solved: all that can be read below is new */
  /** A number is not finite, also the time, or a square that follows from it is not; or forces are
   * missing: as if not fed. */
  SHAPEID_SAMPLE_DECLINED,
  /** Not solved, and shapeid_last_outcome() says why: the last answer stays. */
  SHAPEID_WINDOW_DECLINED,
  SHAPEID_WRONG_ARGUMENT /**< a NULL, or counts that are not the robot's: as if not called */
} shapeid_status;

/** Writes the three base quantities of a sample from what the IMU of robot.yaml measures, in its
 * own axes: gyro (rad/s), its derivative (rad/s^2) and accelerometer (m/s^2). Does nothing if one
 * of them is NULL. */
void shapeid_set_base(const shapeid_identifier* identifier, const double gyro[3],
                      const double gyro_derivative[3], const double accelerometer[3],
                      shapeid_sample* sample);

/** For when the next sample does not follow the last: as if none had been fed so far. The last
 * answer, lambda, filter (17) and the masses to start at stay. Does nothing for NULL. */
void shapeid_forget_samples(shapeid_identifier* identifier);

/** Takes a sample; when a window is complete, solves. Bounded work. Needs some 40 kB of stack. */
shapeid_status shapeid_feed(shapeid_identifier* identifier, const shapeid_sample* sample);

/** How the last window that was complete ended. */
typedef enum shapeid_outcome {
  SHAPEID_OUTCOME_NONE,            /**< no window was complete yet */
  SHAPEID_OUTCOME_SOLVED,          /**< it was answered */
  SHAPEID_OUTCOME_NOT_FINITE,      /**< a number of its rows is not finite */
  SHAPEID_OUTCOME_ILL_CONDITIONED, /**< the masses found do not have the accuracy promised */
  SHAPEID_OUTCOME_TOO_MANY_STEPS,  /**< the bound on the work of one window was reached */
  /** Forces that no robot has: as a root mean square over the window's samples, weighted by the
   * settings' weight, the generalised forces exceed a hundred times the weight of all links
   * (torques: that weight at a metre). Of the free links expected_mass counts, of the others what
   * the URDF says. Such a window would leave its scale to lambda. */
  SHAPEID_OUTCOME_OUT_OF_SCALE
} shapeid_outcome;

/** SHAPEID_OUTCOME_NONE for NULL as well. A feed that only keeps or declines a sample leaves it. */
shapeid_outcome shapeid_last_outcome(const shapeid_identifier* identifier);

/** What ended the divisions of a window. */
typedef enum shapeid_stop {
  SHAPEID_STOP_LIMIT,             /**< most_divisions are done; so always if that is 0 */
  SHAPEID_STOP_STEP,              /**< division_patience steps in a row were below division_step */
  SHAPEID_STOP_NOTHING_DIVISIBLE, /**< no shape that can be divided carries mass */
  /** The masses after one more division could not be solved to the accuracy promised: what is
   * answered is that division at equal density, with parameters and objective as before it. */
  SHAPEID_STOP_DECLINED
} shapeid_stop;

/** About the last window that was answered, but for its three times, which are of the last window
 * that was complete; zeros before the first. */
typedef struct shapeid_answer {
  double time;      /**< s, of the window's last sample */
  double objective; /**< f of (15) for the present shapes, before the filter */
  /** f is at most this much above its minimum over the present shapes, if the masses there add up
   * to no more than mass_bound. Rounding can leave it a little below zero. */
  double gap;
  int iterations;          /**< small systems solved, of all divisions together */
  int divisions;           /**< done in this window */
  shapeid_stop stopped_by; /**< what ended them */
  /** Of all calls that took a sample since the last window, its solve and divisions. */
  double window_seconds;
  double slowest_sample_seconds; /**< of the calls that only kept a sample */
  double last_call_seconds;      /**< of the call that completed the window */
} shapeid_answer;

/** Copies it to `answer`. SHAPEID_ANSWERED, SHAPEID_KEPT if no window was answered yet, or
 * SHAPEID_WRONG_ARGUMENT. */
shapeid_status shapeid_get_answer(const shapeid_identifier* identifier, shapeid_answer* answer);

/** The ten parameters of a free link: m, m rx, m ry, m rz, Ixx, Ixy, Ixz, Iyy, Iyz, Izz; kg, kg m,
 * kg m^2; in the link's axes about the link's origin, products with the tensor's sign (Ixy = -
 * integral of x y dm). Of the last answer, before filter (17). Zeros before the first answer; NULL
 * if there is no such link. What the pointer shows is the identifier's: valid until
 * shapeid_destroy(), renewed by each feed that answers. */
const double* shapeid_parameters(const shapeid_identifier* identifier, size_t free_link);
/** The same after filter (17). It does not minimise any single window's objective. */
const double* shapeid_filtered_parameters(const shapeid_identifier* identifier, size_t free_link);
/** Masses of the shapes before any division, kg, in the order of shapes.yaml: shapeid_shape_count()
 * numbers, valid as above; NULL for NULL. */
const double* shapeid_masses(const shapeid_identifier* identifier);

#ifdef __cplusplus
}
#endif

#endif
