#include "shapeid/app/tell.hpp"

#include <cstdio>

namespace shapeid::app {

void tell(const std::string& text) noexcept {
  static_cast<void>(std::fwrite(text.data(), 1, text.size(), stderr));
}

}  // namespace shapeid::app
