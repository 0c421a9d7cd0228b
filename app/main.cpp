#include <fmt/format.h>

#include <cstdio>
#include <exception>

#include "shapeid/app/verbs.hpp"
#include "shapeid/models/contract.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/models/version.hpp"

namespace {

// Exit statuses (README.md): 0 done, 1 the answer is no, 2 bad input, 3 a defect of ours.
constexpr int no = 1, bad_input = 2, our_defect = 3;

int complain(const char* message, int status) {
  fmt::print(stderr, "shapeid: {}\n", message);
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Inertial parameters of floating-base robots, by primitive shapes of unknown mass"};
  app.set_version_flag("--version", shapeid::version);
  app.require_subcommand(1);
  shapeid::app::add_demo(app);
  shapeid::app::add_identify(app);
  shapeid::app::add_load(app);
  shapeid::app::add_diagnose(app);
  shapeid::app::add_track(app);
  shapeid::app::add_certify(app);
  shapeid::app::add_vectors(app);
  shapeid::app::add_simulate(app);
  shapeid::app::add_inspect(app);
  shapeid::app::add_convert(app);
  try {
    app.parse(argc, argv);
    return 0;
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);  // --help, --version
    return complain(e.what(), bad_input);
  } catch (const shapeid::InputError& e) {
    return complain(e.what(), bad_input);
  } catch (const shapeid::Refusal& e) {
    return complain(e.what(), no);
  } catch (const std::exception& e) {
    return complain(
        fmt::format("this is a defect of shapeid, please report it: {}", e.what()).c_str(),
        our_defect);
  }
}
