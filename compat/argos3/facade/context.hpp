// The owner of the ARGoS code that runs on a thread: takes its text, seeds its random numbers.
#pragma once
#include <argos3/core/utility/math/rng.h>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tandem::compat::argos3 {

/// A robot's controller, or the experiment's loop functions. Outlives its generators.
class Context {
 public:
  virtual ~Context() = default;
  /// A line, or several, of LOG or LOGERR.
  virtual void tell(bool error, std::string_view text) = 0;

  /// Seeds generators that are made from now on, and begins those again that were made.
  void set_seed(std::uint64_t seed);
  /// Makes a generator of the category's seed and of this seed.
  argos::CRandom::CRNG* make_generator(std::uint64_t category_seed);

 private:
  std::uint64_t seed_ = 0;
  std::vector<std::pair<argos::CRandom::CRNG*, std::uint64_t>> generators_;  // and their categories' seeds
};

/// Of this thread; null when no code of ARGoS runs on it.
Context* current_context() noexcept;

/// Makes a context this thread's for as long as this lives, then hands over the rest of its text.
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
