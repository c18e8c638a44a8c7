// A hook that measures, and that ends badly with some seeds.
#include <csignal>
#include <cstdio>
#include <stdexcept>
#include <string>

#include "core/hook/hook.hpp"
#include "core/space/space.hpp"

namespace {

using namespace tandem;

class Measuring final : public core::Hook {
 public:
  struct Params {
    double gain = 1.0;
    std::int64_t throw_seed = -1, crash_seed = -1, loop_seed = -1, until = -1;
    std::string mended;
    void describe(hal::ParamVisitor& v) {
      v.number("gain", gain, hal::unit::none, {0.0, 100.0}, "Items a tick.");
      v.integer("throw_seed", throw_seed, hal::kAny, "Throws with this seed, after tick 3 …");
      v.text("mended", mended, "… unless this file is there.");
      v.integer("crash_seed", crash_seed, hal::kAny, "Crashes with this seed.");
      v.integer("loop_seed", loop_seed, hal::kAny, "Never returns with this seed.");
      v.integer("until", until, hal::kAny, "Is done at this tick.");
    }
  };
  explicit Measuring(const Params& params) : params_(params) {}

  void after_step(core::HookContext& c) override {
    const auto seed = static_cast<std::int64_t>(c.seed);
    c.measures.add("items",
                   params_.gain * static_cast<double>(1 + (c.seed * 7 + static_cast<std::uint64_t>(c.tick)) % 3));
    if (c.tick >= 5) c.measures.set("late, and \"odd\"", static_cast<double>(c.tick) / 3.0);
    if (c.tick < 3) return;
    if (seed == params_.throw_seed && !is_there(params_.mended)) throw std::runtime_error("lost count");
    if (seed == params_.crash_seed) std::raise(SIGSEGV);
    volatile bool forever = seed == params_.loop_seed;
    while (forever) {
    }
  }
  bool is_done(core::HookContext& c) override { return c.tick == params_.until; }

 private:
  static bool is_there(const std::string& path) {
    if (path.empty()) return false;
    std::FILE* const file = std::fopen(path.c_str(), "r");
    if (file != nullptr) std::fclose(file);
    return file != nullptr;
  }
  Params params_;
};

void register_all(hal::Registrar& registrar) {
  registrar.add(core::hook_type<Measuring>("measuring", "Counts, and fails when asked to."));
}
}  // namespace
TANDEM_PLUGIN(register_all)
