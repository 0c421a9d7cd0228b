#include "shapeid/app/option_checks.hpp"

#include <fmt/format.h>

#include <functional>
#include <optional>
#include <string>

#include "shapeid/models/number.hpp"

namespace shapeid::app {
namespace {

CLI::Validator number_that(const std::function<bool(double)>& is_right, const std::string& right) {
  return {[=](const std::string& text) -> std::string {
            const std::optional<double> number = parse_number(text);
            if (!number) return fmt::format("{}; must be {}", why_no_number(text), right);
            return is_right(*number) ? std::string()
                                     : fmt::format("is {}; must be {}", text, right);
          },
          "NUMBER " + right};
}

}  // namespace

CLI::Validator above_zero() {
  return number_that([](double x) { return x > 0.0; }, "above 0");
}

CLI::Validator zero_or_above() {
  return number_that([](double x) { return x >= 0.0; }, "at least 0");
}

}  // namespace shapeid::app
