#include "shapeid/app/noted_refusal.hpp"

#include <algorithm>

namespace shapeid::app {

NotedRefusal::NotedRefusal(const Refusal& refusal, const std::vector<std::string>& notes)
    : Refusal(refusal) {
  if (const auto* noted = dynamic_cast<const NotedRefusal*>(&refusal)) notes_ = noted->notes();
  for (const std::string& note : notes) {
    if (std::ranges::find(notes_, note) == notes_.end()) notes_.push_back(note);
  }
}

}  // namespace shapeid::app
