#include "shapeid/app/option_checks.hpp"
#include "shapeid/app/run_command.hpp"
#include "shapeid/app/verbs.hpp"
#include "shapeid/models/version.hpp"

int main(int argc, char** argv) {
  CLI::App app{"Inertial parameters of floating-base robots, by primitive shapes of unknown mass"};
  app.set_version_flag("--version", shapeid::version);
  app.require_subcommand(1);
  shapeid::app::add_demo(app);
  shapeid::app::add_identify(app);
  shapeid::app::add_batch(app);
  shapeid::app::add_load(app);
  shapeid::app::add_diagnose(app);
  shapeid::app::add_track(app);
  shapeid::app::add_certify(app);
  shapeid::app::add_vectors(app);
  shapeid::app::add_simulate(app);
  shapeid::app::add_inspect(app);
  shapeid::app::add_convert(app);
  shapeid::app::check_values_first(app);
  return shapeid::app::run_command(app, argc, argv);
}
