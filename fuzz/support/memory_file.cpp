#include "shapeid/fuzz/support/memory_file.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include "shapeid/fuzz/support/check.hpp"

namespace shapeid::fuzz {

MemoryFile::MemoryFile(const std::uint8_t* bytes, std::size_t size)
    : file_(::memfd_create("input", MFD_CLOEXEC)), path_("/proc/self/fd/" + std::to_string(file_)) {
  check(file_ >= 0, "a file in memory can be made");
  check(::write(file_, bytes, size) == static_cast<ssize_t>(size), "it takes the input");
}

MemoryFile::MemoryFile(const std::string& text)
    : MemoryFile(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()) {}

MemoryFile::~MemoryFile() { ::close(file_); }

}  // namespace shapeid::fuzz
