// Runs a fuzz target without libFuzzer: over files, and over files changed at random, from a seed.
//
// usage: fuzz_TARGET [--random N] [--seed S] FILE|FOLDER ...
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "shapeid/fuzz/support/declines.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

using Input = std::vector<std::uint8_t>;

constexpr const char* kept = "failed-input";

/// The input that the target is at work on, for the handler below.
const Input* present = nullptr;

void keep_and_die(int signal) {
  std::signal(signal, SIG_DFL);
  const int file = ::open(kept, O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (file >= 0 && present != nullptr && ::write(file, present->data(), present->size()) >= 0) {
    std::fprintf(stderr, "the input is kept in %s\n", kept);
  }
  ::raise(signal);
}

void run(const Input& input) {
  present = &input;
  LLVMFuzzerTestOneInput(input.data(), input.size());
  present = nullptr;
}

Input read(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Files of folders in the order of their names, so that a seed means the same everywhere.
std::vector<Input> read_all(const std::vector<std::string>& places) {
  std::vector<std::filesystem::path> files;
  for (const std::string& place : places) {
    if (!std::filesystem::is_directory(place)) {
      files.emplace_back(place);
      continue;
    }
    for (const auto& entry : std::filesystem::directory_iterator(place)) files.push_back(entry);
  }
  std::sort(files.begin(), files.end());
  std::vector<Input> inputs;
  std::transform(files.begin(), files.end(), std::back_inserter(inputs), read);
  return inputs;
}

class Mutator {
 public:
  Mutator(std::uint64_t seed, const std::vector<Input>& inputs) : random_(seed), inputs_(inputs) {}

  Input next() {
    Input input = any();
    for (std::size_t changes = 1 + below(4); changes > 0; --changes) change(input);
    return input;
  }

 private:
  std::size_t below(std::size_t bound) { return bound == 0 ? 0 : random_() % bound; }
  const Input& any() { return inputs_[below(inputs_.size())]; }

  void change(Input& input) {
    const auto at = static_cast<std::ptrdiff_t>(below(input.size()));
    const auto some = static_cast<std::ptrdiff_t>(
        below(std::min<std::size_t>(input.size() - static_cast<std::size_t>(at), 64)));
    switch (below(5)) {
      case 0:  // a bit
        if (!input.empty()) input[static_cast<std::size_t>(at)] ^= std::uint8_t(1U << below(8));
        break;
      case 1:  // a byte
        if (!input.empty()) input[static_cast<std::size_t>(at)] = std::uint8_t(below(256));
        break;
      case 2:  // a part less
        input.erase(input.begin() + at, input.begin() + at + some);
        break;
      case 3: {  // a part twice
        const Input part(input.begin() + at, input.begin() + at + some);
        input.insert(input.begin() + at, part.begin(), part.end());
        break;
      }
      default: {  // the end of another one
        const Input& other = any();
        input.resize(static_cast<std::size_t>(at));
        input.insert(input.end(), other.begin() + static_cast<std::ptrdiff_t>(below(other.size())),
                     other.end());
      }
    }
  }

  std::mt19937_64 random_;
  const std::vector<Input>& inputs_;
};

}  // namespace

int main(int argc, char** argv) {
  std::uint64_t random = 0, seed = 1;
  std::vector<std::string> places;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if ((word == "--random" || word == "--seed") && i + 1 < argc) {
      (word == "--seed" ? seed : random) = std::strtoull(argv[++i], nullptr, 10);
    } else {
      places.push_back(word);
    }
  }
  for (const int signal : {SIGABRT, SIGSEGV, SIGFPE, SIGBUS, SIGILL}) {
    std::signal(signal, keep_and_die);
  }
  const std::vector<Input> inputs = read_all(places);
  for (const Input& input : inputs) run(input);
  if (inputs.empty()) {
    std::fprintf(stderr, "no inputs\n");
    return EXIT_FAILURE;
  }
  Mutator mutator(seed, inputs);
  for (std::uint64_t i = 0; i < random; ++i) run(mutator.next());
  std::printf("%zu inputs, %llu changed at random\n", inputs.size(),
              static_cast<unsigned long long>(random));
  const shapeid::fuzz::Declines& declines = shapeid::fuzz::declines;
  if (declines.asked == 0) return EXIT_SUCCESS;
  std::printf("the fast path declined %llu of %llu\n",
              static_cast<unsigned long long>(declines.declined),
              static_cast<unsigned long long>(declines.asked));
  if (!declines.too_many()) return EXIT_SUCCESS;
  std::fprintf(stderr, "broken: the fast path declines more than a tenth of what it is asked\n");
  return EXIT_FAILURE;
}
