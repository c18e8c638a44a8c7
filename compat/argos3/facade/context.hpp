// Whose ARGoS code runs on a thread: where its text goes, and what its random numbers follow from.
#pragma once
#include <argos3/core/utility/math/rng.h>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tandem::compat::argos3 {

/// A robot's controller, or the experiment's loop functions. Lives at least as long as what was made under it.
class Context {
 public:
  virtual ~Context() = default;
  /// A line, or several, of LOG or LOGERR.
  virtual void tell(bool error, std::string_view text) = 0;

  /// What generators follow from that are made now; those that were made begin anew.
  void set_seed(std::uint64_t seed);
  /// Makes a generator of the category's seed and of this seed.
  argos::CRandom::CRNG* make_generator(std::uint64_t category_seed);

 private:
  std::uint64_t seed_ = 0;
  std::vector<std::pair<argos::CRandom::CRNG*, std::uint64_t>> generators_;  // and their categories' seeds
};

/// Of this thread; null when no code of ARGoS runs on it.
Context* current_context() noexcept;

/// Makes a context this thread's for as long as this lives, then tells what is left of its text.
class ContextScope {
 public:
  explicit ContextScope(Context& context) noexcept;
  ~ContextScope();
  ContextScope(const ContextScope&) = delete;
  ContextScope& operator=(const ContextScope&) = delete;

 private:
  Context* outer_;
};

/// The run's seed, as CRandom::GetSeedOf("argos") gives it.
void set_run_seed(std::uint64_t seed);

}  // namespace tandem::compat::argos3
