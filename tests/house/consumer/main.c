/* The installed C interface: exits 0 if it makes an identifier, counts, answers and refuses.
 * Arguments: URDF, robot.yaml and shapes.yaml of the bundled quadruped. */
#include <shapeid/fast/shapeid.h>
#include <stdio.h>
#include <string.h>

/* In free fall nothing needs a force. */
static shapeid_status fall(shapeid_identifier* identifier) {
  static const double zeros[12];
  static const unsigned char in_the_air[4];
  shapeid_sample sample = {0};
  shapeid_status status = SHAPEID_KEPT;
  int i = 0;
  sample.joint_count = 12;
  sample.q = sample.dq = sample.ddq = sample.tau = zeros;
  sample.contact_count = 4;
  sample.in_contact = in_the_air;
  for (i = 0; i < 10; ++i) status = shapeid_feed(identifier, &sample);
  return status;
}

int main(int argc, char** argv) {
  char error[200] = "";
  shapeid_identifier* identifier = NULL;
  int works = 0;
  if (argc != 4) return 1;
  identifier = shapeid_create("nowhere.urdf", NULL, NULL, NULL, error, sizeof error);
  if (identifier != NULL || strstr(error, "nowhere.urdf") == NULL) return 1;
  identifier = shapeid_create(argv[1], argv[2], argv[3], NULL, error, sizeof error);
  if (identifier == NULL) {
    fprintf(stderr, "%s\n", error);
    return 1;
  }
  works = shapeid_joint_count(identifier) == 12 && shapeid_contact_count(identifier) == 4 &&
          fall(identifier) == SHAPEID_ANSWERED && shapeid_parameters(identifier, 0)[0] == 0.0;
  shapeid_destroy(identifier);
  return works ? 0 : 1;
}
