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

  /// Seeds generators that are made from now on, and begins those again that were made. `name`: of a robot.
  void set_seed(std::uint64_t seed, std::string_view name = {});
  /// Begins a generator that is made in this context: with the seed of this context in the category "argos", else with
  /// the category's, and the robot's name.
  void take(argos::CRandom::CRNG& generator, const argos::CRandom::CCategory& category);

 private:
  std::uint64_t seed_ = 0;
  std::string name_;
  struct Taken {
    argos::CRandom::CRNG* generator;
    bool of_run;  // its seed is the context's
  };
  std::vector<Taken> taken_;
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
