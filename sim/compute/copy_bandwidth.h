// How fast this machine copies memory: what a simulation that only moves bytes could reach.
#pragma once

#include <cstddef>

#include "sim/compute/thread_pool.h"

namespace fude {

// GB/s (10^9 bytes read plus bytes written), the best of memcpy and of streaming stores over `bytes` each
// way, shared among the pool's threads; the best of `rounds`.
double copy_gigabytes_per_second(ThreadPool& pool, std::size_t bytes, int rounds);

}  // namespace fude
