// A worker's messages about a run, as bytes.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "study/run_row.hpp"

namespace tandem::study {

/// An outcome with the number of its run, ready to be sent.
std::string message_of(std::int64_t run, const RunOutcome& outcome);

struct ToldOutcome {
  std::int64_t run = 0;
  RunOutcome outcome;
};

/// Takes the first message out of `received` when it is there as a whole.
std::optional<ToldOutcome> take_message(std::string& received);

}  // namespace tandem::study
