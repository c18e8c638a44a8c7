// Foraging with objects that are carried: takes them from the nest back to the source, and counts.
#pragma once
#include <deque>
#include <string>
#include <vector>

#include "core/hook/hook.hpp"
#include "core/space/space.hpp"
#include "hal/params.hpp"

namespace tandem::hooks {

/// All movable objects of the file are what the robots are to bring. One that lies in the nest and that no robot holds
/// any more has been brought: it is counted and put back to a free place at the source, so that the source is never
/// exhausted. The nest is the western end of the arena; with `<floor source="loop_functions"/>` its floor is black and
/// the rest white.
///
/// Throughput is the number of objects brought during the last `window`: the measure "throughput", beside "brought"
/// since the start; also written to a CSV file every `every`: `time_s,throughput,brought`, as Pinciroli et al. (2012),
/// section 4.2.2, measure it. The first full window ends at `window`; earlier samples count since the start.
class Throughput final : public core::Hook {
 public:
  struct Params {
    double nest_x_m = -1.8;
    std::array<double, 3> source_m = {2.0, 0.0, 0.0};
    double spacing_m = 0.35;
    double window_s = 900.0;
    double every_s = 120.0;
    std::string output;
    void describe(hal::ParamVisitor& v) {
      v.number("nest", nest_x_m, hal::unit::m, hal::kAny, "The nest is where x is less.");
      v.vector("source", source_m, hal::unit::m, "Middle of the source.");
      v.number("spacing", spacing_m, hal::unit::m, {0.01, 10.0}, "Between objects that are put back.");
      v.number("window", window_s, hal::unit::s, {1.0, 1e6}, "Throughput is counted over the last so many seconds.");
      v.number("every", every_s, hal::unit::s, {0.1, 1e6}, "Time between samples.");
      v.text("output", output, "CSV file for the samples, written at the end; empty: none.");
    }
  };

  explicit Throughput(const Params& params) : params_(params) {}

  void after_step(core::HookContext& context) override;
  /// @throws std::runtime_error when the file cannot be written
  void after_run(core::HookContext& context) override;
  std::optional<double> floor(double x_m, double y_m) override;
  bool remember(hal::Archive& a) override {
    a(state_.recent, state_.brought, state_.samples);
    return true;
  }

 private:
  struct Sample {
    double time_s = 0.0;
    std::size_t throughput = 0, brought = 0;
  };
  struct State {
    std::deque<hal::Tick> recent;  ///< ticks of the arrivals in the window
    std::size_t brought = 0;
    std::vector<Sample> samples;
  };

  bool put_back(core::Space& space, std::size_t number) const;

  Params params_;
  State state_;
};

}  // namespace tandem::hooks
