// Observers: look at a world after every tick and write their results down.
#pragma once
#include <exception>
#include <memory>
#include <string_view>

#include "core/hook/measures.hpp"
#include "core/scenario/observer_type.hpp"
#include "core/space/space.hpp"
#include "core/space/stores.hpp"
#include "hal/time.hpp"

namespace tandem::core {

/// What an observer sees: the state at the end of a tick.
struct Observation {
  const Space& space;
  const Measures& measures;  ///< what hooks publish
  hal::Tick tick = 0;        ///< that was just done; at the start: the first one
  std::int64_t ticks_per_second = 10;
  std::uint64_t seed = 0;
};

/// Looks at the world and changes nothing of it. Called from the thread that steps, between steps. What it throws is
/// told as what it returns: once; it is then not called again, and the run goes on.
class Observer {
 public:
  Observer() noexcept { hal::detail::note_surface<StoresSurface>(); }
  virtual ~Observer() = default;

  /// After every tick.
  virtual hal::Status observe(const Observation& now) = 0;
  /// Twice a second: hands to the system what shall outlive a crash.
  virtual hal::Status flush() { return {}; }
  /// After the last tick, however the run ended.
  virtual hal::Status finish(const Observation& /*last*/) { return {}; }
};

/// The table of observer class `T`, constructed from `(const T::Params&, const Observation& start)`; what that throws
/// is a problem of its element.
template <class T>
ObserverType observer_type(std::string_view name, std::string_view summary) {
  return {name, summary, [](hal::ParamVisitor& visitor) { typename T::Params{}.describe(visitor); },
          [](const Element& element, const Observation& start, Problems& problems) -> std::unique_ptr<Observer> {
            const std::size_t before = problems.size();
            const auto params = read_settings<typename T::Params>(element, problems);
            if (has_errors(problems, before)) return nullptr;
            try {
              return std::make_unique<T>(params, start);
            } catch (const std::exception& e) {
              problems.push_back(problem_at(element, e.what()));
              return nullptr;
            }
          }};
}

}  // namespace tandem::core
