// shapeid_mpi: `shapeid batch` over the processes of mpirun, each of which reads its share of the
// logs. Triangles travel as messages between two processes, in an order of ours: what MPI_Reduce
// does to numbers depends on the library.
#include <fmt/format.h>
#include <mpi.h>

#include <limits>

#include "shapeid/app/batch.hpp"
#include "shapeid/app/option_checks.hpp"
#include "shapeid/app/run_command.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/models/version.hpp"

namespace {

class MpiPeers final : public shapeid::app::Peers {
 public:
  [[nodiscard]] std::size_t rank() const override { return asked(MPI_Comm_rank); }
  [[nodiscard]] std::size_t count() const override { return asked(MPI_Comm_size); }

  void send(const std::string& bytes, std::size_t to) override {
    if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
      throw shapeid::Refusal("too-large", "a triangle does not fit into one message of MPI");
    }
    MPI_Send(bytes.data(), static_cast<int>(bytes.size()), MPI_BYTE, static_cast<int>(to), tag,
             MPI_COMM_WORLD);
  }

  [[nodiscard]] std::string receive(std::size_t from) override {
    MPI_Status status;
    MPI_Probe(static_cast<int>(from), tag, MPI_COMM_WORLD, &status);
    int size = 0;
    MPI_Get_count(&status, MPI_BYTE, &size);
    std::string bytes(static_cast<std::size_t>(size), '\0');
    MPI_Recv(bytes.data(), size, MPI_BYTE, static_cast<int>(from), tag, MPI_COMM_WORLD,
             MPI_STATUS_IGNORE);
    return bytes;
  }

 private:
  static constexpr int tag = 0;  // one stream from one process to another

  static std::size_t asked(int (*what)(MPI_Comm, int*)) {
    int number = 0;
    what(MPI_COMM_WORLD, &number);
    return static_cast<std::size_t>(number);
  }
};

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  MpiPeers peers;
  shapeid::app::BatchOptions options;
  CLI::App app{"shapeid batch, over the processes of mpirun"};
  app.set_version_flag("--version", shapeid::version);
  options.add_to(app);
  app.get_option("--threads")->default_val(std::size_t{1});
  app.callback([&] { batch(options, peers); });
  shapeid::app::check_values_first(app);
  const int status = shapeid::app::run_command(app, argc, argv);
  // The others wait for messages of the one that failed.
  if (status != 0) MPI_Abort(MPI_COMM_WORLD, status);
  MPI_Finalize();
  return status;
}
