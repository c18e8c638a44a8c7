// What a run knows of worlds: apart, because boards of robots have none.
#include "core/run/run.hpp"

namespace tandem::core {
namespace {

class WorldSteps final : public Stepped {
 public:
  explicit WorldSteps(World& world) : world_(world) {}
  void start() override { world_.start(); }
  bool step() override { return world_.step(); }
  void finish() override { world_.finish(); }
  hal::Tick tick() const override { return world_.tick(); }
  bool running() const override { return world_.state() == RunState::Running; }

 private:
  World& world_;
};

}  // namespace

Run::Run(World& world, const std::atomic<bool>& stop)
    : world_(&world), world_steps_(std::make_unique<WorldSteps>(world)), stepped_(world_steps_.get()), stop_(stop) {}

}  // namespace tandem::core
