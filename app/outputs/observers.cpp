#include "app/outputs/observers.hpp"

#include <exception>

#include "app/exit_code.hpp"
#include "app/process/terminal.hpp"
#include "hal/plugin_call.hpp"

namespace tandem::app {
namespace {

void name_observer(const void* name, std::size_t /*part*/, std::size_t /*index*/, hal::FixedText& out) noexcept {
  out << *static_cast<const std::string*>(name);
}

/// What the call says of itself, or throws.
template <class Call>
hal::Status asked(const std::string& name, Call&& call) {
  const hal::PluginCall marked(&name_observer, &name);
  try {
    return call();
  } catch (const std::exception& e) {
    return hal::Error{"threw: " + std::string(e.what())};
  } catch (...) {
    return hal::Error{"threw"};
  }
}

}  // namespace

core::Observation observation_of(const core::World& world, hal::Tick tick) {
  return {world.space(), world.measures(), tick, world.ticks_per_second(), world.seed()};
}

Observers Observers::make(const core::Scenario& scenario, const hal::Catalog& catalog, const core::World& world,
                          core::Problems& problems) {
  Observers made;
  const core::Observation start = observation_of(world, world.tick());
  for (const core::Element& element : scenario.observers) {
    const auto* const type = catalog.find<core::ObserverType>(element.name);
    TANDEM_CHECK(type != nullptr, "the reader knows every observer of the file");
    const std::string origin = catalog.origin_of(type);
    Watching watching;
    watching.name =
        "observer '" + element.name + "'" + (origin == hal::Catalog::kInside ? "" : " (library '" + origin + "')");
    const std::size_t before = problems.size();
    const hal::Status called = asked(watching.name, [&]() -> hal::Status {
      watching.observer = type->make(element, start, problems);
      return {};
    });
    if (!called.ok()) problems.push_back(core::problem_at(element, watching.name + " " + called.error().message));
    if (watching.observer == nullptr && !core::has_errors(problems, before))
      problems.push_back(core::problem_at(element, watching.name + " was not made, and does not say why"));
    made.all_.push_back(std::move(watching));
  }
  return made;
}

template <class Call>
void Observers::each(Call&& call) {
  for (Watching& watching : all_) {
    if (watching.failed) continue;
    const hal::Status done = asked(watching.name, [&] { return call(*watching.observer); });
    if (done.ok()) continue;
    watching.failed = true;
    complain(kFailedRunning, watching.name + ": " + done.error().message + "; the run goes on without it");
  }
}

void Observers::tick_done(const core::World& world) {
  if (all_.empty() || world.tick() == 0) return;  // 0: a hook went back to the start
  const core::Observation now = observation_of(world, world.tick() - 1);
  each([&](core::Observer& observer) { return observer.observe(now); });
}

void Observers::flush() {
  each([](core::Observer& observer) { return observer.flush(); });
}

bool Observers::finish(const core::World& world) {
  if (all_.empty()) return true;
  const core::Observation last = observation_of(world, world.tick() == 0 ? 0 : world.tick() - 1);
  each([&](core::Observer& observer) { return observer.finish(last); });
  for (const Watching& watching : all_) {
    if (watching.failed) return false;
  }
  return true;
}

}  // namespace tandem::app
