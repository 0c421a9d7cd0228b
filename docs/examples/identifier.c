/* Samples in, parameters out: the fast identifier in C (C99).
 *
 *   identifier ROBOT.urdf ROBOT.yaml SHAPES.yaml [DIVISIONS] < samples
 *   identifier models/robots/quadruped.{urdf,robot.yaml,shapes.yaml} < samples
 *
 * A line of `samples` is one instant, numbers separated by blanks, SI units and radians, in the
 * order
 *   time
 *   base: angular velocity (3), angular acceleration (3), specific force (3), in base axes
 *   q of every joint, dq of every joint, ddq of every joint, tau of every joint
 *   for every contact 1 (touches) or 0
 * with joints and contacts in the order of shapeid_joint_name() and shapeid_contact_name(). That is
 * 62 numbers for the bundled quadruped.
 *
 * Writes a line for every window of ten samples: time, objective, gap, divisions done (at most
 * DIVISIONS, or none), what ended them, then the ten parameters of each link that is sought, after
 * filter (17). Exit status: 0 done, 1 no window was answered, 2 bad
 * input. */
#include <ctype.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>

#include "shapeid/fast/shapeid.h"

enum { done = 0, no_answer = 1, bad_input = 2, before_joints = 10 };

/* The next character that is no blank; the end of the line is none. */
static int next_in_line(FILE* in) {
  int c = fgetc(in);
  while (c != '\n' && isspace(c)) c = fgetc(in);
  return c;
}

/* The next number of the present line; 0 if the line ends first or goes on with something else. */
static int read_number(FILE* in, double* number) {
  const int c = next_in_line(in);
  if (c == EOF || c == '\n') return 0;
  ungetc(c, in);
  return fscanf(in, "%lf", number) == 1;
}

static int line_ends(FILE* in) {
  const int c = next_in_line(in);
  return c == EOF || c == '\n';
}

static int input_ends(FILE* in) {
  const int c = fgetc(in);
  if (c != EOF) ungetc(c, in);
  return c == EOF;
}

/* How many of the `count` numbers the next line has: more than count if the line is longer. */
static size_t read_line(FILE* in, double* numbers, size_t count) {
  size_t read = 0;
  while (read < count && read_number(in, &numbers[read])) ++read;
  return read == count && !line_ends(in) ? count + 1 : read;
}

static const char* name_of(shapeid_stop stop) {
  switch (stop) {
    case SHAPEID_STOP_LIMIT:
      return "limit";
    case SHAPEID_STOP_STEP:
      return "step";
    case SHAPEID_STOP_NOTHING_DIVISIBLE:
      return "nothing-divisible";
    case SHAPEID_STOP_DECLINED:
      break;
  }
  return "declined";
}

static void print_answer(const shapeid_identifier* identifier) {
  shapeid_answer answer;
  size_t link = 0, i = 0;
  shapeid_get_answer(identifier, &answer);
  printf("%.17g %.17g %.17g %d %s", answer.time, answer.objective, answer.gap, answer.divisions,
         name_of(answer.stopped_by));
  for (link = 0; link < shapeid_free_link_count(identifier); ++link) {
    const double* parameters = shapeid_filtered_parameters(identifier, link);
    for (i = 0; i < 10; ++i) printf(" %.17g", parameters[i]);
  }
  printf("\n");
}

/* Numbers of one line, and where the identifier finds them. */
typedef struct line {
  double* numbers;
  size_t count;
  unsigned char* in_contact;
  shapeid_sample sample;
} line;

static int make_line(const shapeid_identifier* identifier, line* made) {
  const size_t joints = shapeid_joint_count(identifier);
  const size_t contacts = shapeid_contact_count(identifier);
  made->count = before_joints + 4 * joints + contacts;
  made->numbers = malloc(made->count * sizeof *made->numbers);
  made->in_contact = malloc(contacts + 1);
  if (made->numbers == NULL || made->in_contact == NULL) return 0;
  made->sample.joint_count = joints;
  made->sample.q = made->numbers + before_joints;
  made->sample.dq = made->sample.q + joints;
  made->sample.ddq = made->sample.dq + joints;
  made->sample.tau = made->sample.ddq + joints;
  made->sample.contact_count = contacts;
  made->sample.in_contact = made->in_contact;
  made->sample.contact_force = NULL;
  return 1;
}

/* 0 if a contact neither touches nor does not. */
static int take_numbers(line* from) {
  const double* contacts = from->sample.tau + from->sample.joint_count;
  size_t i = 0;
  from->sample.time = from->numbers[0];
  for (i = 0; i < 3; ++i) {
    from->sample.base_angular_velocity[i] = from->numbers[1 + i];
    from->sample.base_angular_acceleration[i] = from->numbers[4 + i];
    from->sample.base_specific_force[i] = from->numbers[7 + i];
  }
  for (i = 0; i < from->sample.contact_count; ++i) {
    if (contacts[i] != 0.0 && contacts[i] != 1.0) return 0;
    from->in_contact[i] = contacts[i] == 1.0;
  }
  return 1;
}

static int identify(shapeid_identifier* identifier, line* next) {
  unsigned long number = 1, answers = 0;
  for (; !input_ends(stdin); ++number) {
    const size_t found = read_line(stdin, next->numbers, next->count);
    if (found != next->count) {
      fprintf(stderr, "samples:%lu: %s numbers than %lu, or one is not a number\n", number,
              found < next->count ? "fewer" : "more", (unsigned long)next->count);
      return bad_input;
    }
    if (!take_numbers(next)) {
      fprintf(stderr, "samples:%lu: a contact is neither 0 nor 1\n", number);
      return bad_input;
    }
    switch (shapeid_feed(identifier, &next->sample)) {
      case SHAPEID_ANSWERED:
        print_answer(identifier);
        ++answers;
        break;
      case SHAPEID_SAMPLE_DECLINED:
        fprintf(stderr, "samples:%lu: declined, not finite\n", number);
        break;
      case SHAPEID_WINDOW_DECLINED:
        fprintf(stderr, "samples:%lu: the window that ends here is declined\n", number);
        break;
      case SHAPEID_KEPT:
      case SHAPEID_WRONG_ARGUMENT: /* the line was made for this robot */
        break;
    }
  }
  if (answers == 0) {
    fprintf(stderr, "samples: no window was answered\n");
    return no_answer;
  }
  return done;
}

/* Zero or more, and nothing behind the number; otherwise -1. */
static int count_in(const char* text) {
  char* end = NULL;
  const long count = strtol(text, &end, 10);
  return end != text && *end == '\0' && count >= 0 && count <= INT_MAX ? (int)count : -1;
}

int main(int argc, char** argv) {
  char error[512];
  shapeid_settings settings;
  line next = {0};
  int status = bad_input;
  shapeid_identifier* identifier = NULL;
  shapeid_default_settings(&settings);
  if (argc == 5) settings.most_divisions = count_in(argv[4]);
  if (argc < 4 || argc > 5 || settings.most_divisions < 0) {
    fprintf(stderr, "usage: %s ROBOT.urdf ROBOT.yaml SHAPES.yaml [DIVISIONS] < samples\n", argv[0]);
    return bad_input;
  }
  identifier = shapeid_create(argv[1], argv[2], argv[3], &settings, error, sizeof error);
  if (identifier == NULL) {
    fprintf(stderr, "%s\n", error);
    return bad_input;
  }
  if (make_line(identifier, &next)) {
    status = identify(identifier, &next);
  } else {
    fprintf(stderr, "out of memory\n");
  }
  free(next.numbers);
  free(next.in_contact);
  shapeid_destroy(identifier);
  if (fflush(stdout) != 0 || ferror(stdout)) {
    fprintf(stderr, "standard output cannot be written\n");
    return bad_input;
  }
  return status;
}
