// Promises of our own code. A broken one is a bug here, never bad input.
#pragma once
#include <cstdio>
#include <cstdlib>

/// Aborts with a message when `condition` does not hold; also in release builds.
#define TANDEM_CHECK(condition, why)                                                                           \
  do {                                                                                                         \
    if (!(condition)) {                                                                                        \
      std::fprintf(stderr, "tandem: broken promise at %s:%d: %s (%s)\n", __FILE__, __LINE__, why, #condition); \
      std::abort();                                                                                            \
    }                                                                                                          \
  } while (false)
