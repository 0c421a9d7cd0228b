// The same job for many things, on several threads.
#pragma once

#include <cstddef>
#include <functional>

namespace shapeid::diagnosis {

/// Calls job(0) to job(count - 1), each once, on that many threads (one: on the caller's). A job
/// may only touch what belongs to its number. When all have ended, the exception of the smallest
/// number that threw is thrown again.
void in_parallel(std::size_t count, std::size_t threads,
                 const std::function<void(std::size_t)>& job);

}  // namespace shapeid::diagnosis
