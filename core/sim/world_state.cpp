// Keeps the state of a world, and goes back to it.
#include <utility>

#include "core/sim/world_impl.hpp"

namespace tandem::core {
namespace {

/// Takes down the values of all controls in their order, or gives them those that were taken down.
class KeptControls final : public hal::Controls {
 public:
  /// Null: takes them down.
  explicit KeptControls(const std::vector<ControlValue>* kept) : kept_(kept) {}
  bool number(std::string_view, double& value, const hal::Unit&, hal::Range, std::string_view) override {
    return pass(value);
  }
  bool integer(std::string_view, std::int64_t& value, hal::Range, std::string_view) override { return pass(value); }
  bool flag(std::string_view, bool& value, std::string_view) override { return pass(value); }
  bool choice(std::string_view, std::string& value, std::span<const std::string_view>, std::string_view) override {
    return pass(value);
  }
  bool text(std::string_view, std::string& value, std::string_view) override { return pass(value); }
  bool button(std::string_view, std::string_view) override {
    std::monostate none;
    return pass(none);
  }

  std::vector<ControlValue> values;

 private:
  template <class T>
  bool pass(T& value) {
    if (kept_ == nullptr) {
      values.emplace_back(value);
      return false;
    }
    const T* const was = next_ < kept_->size() ? std::get_if<T>(&(*kept_)[next_]) : nullptr;
    ++next_;
    if (was == nullptr || *was == value) return false;
    value = *was;
    return true;
  }
  const std::vector<ControlValue>* kept_;
  std::size_t next_ = 0;
};

}  // namespace

/// @throws what the hook does
std::vector<ControlValue> World::Impl::control_values(std::size_t hook) {
  KeptControls reader(nullptr);
  HookContext context = hook_context();
  hooks[hook]->controls(context, reader);
  return std::move(reader.values);
}

hal::Status World::Impl::put_back_controls(const std::vector<std::vector<ControlValue>>& saved) {
  hal::Status all;
  for (std::size_t i = 0; i < hooks.size(); ++i) {
    if (saved[i].empty()) continue;
    KeptControls writer(&saved[i]);
    HookContext context = hook_context();
    const std::string why = asked(i, "controls", [&](Hook& hook) { hook.controls(context, writer); });
    if (!why.empty()) all = hal::Error{why};
  }
  return all;
}

hal::Result<Snapshot> World::snapshot() {
  Impl& w = *impl_;
  if (w.external != nullptr) return hal::Error{"no snapshot: real robots or peers take part, which cannot be put back"};
  auto saved = std::make_shared<SavedWorld>();
  for (std::size_t i = 0; i < w.hooks.size(); ++i) {
    const std::string why = w.asked(i, "save", [&](Hook& hook) {
      saved->hooks.push_back(hook.save());
      saved->hook_controls.push_back(w.control_values(i));
    });
    if (!why.empty()) return hal::Error{"no snapshot: " + why};
  }
  hal::Result<std::unique_ptr<SpaceCopy>> copy = SpaceCopy::take(w.space, w.devices);
  if (!copy.ok()) return copy.error();
  hal::Archive engines;
  if (const hal::Status kept = w.remember_engines(engines); !kept.ok()) return kept.error();
  saved->engines = engines.take();
  saved->of = w.identity;
  saved->space = std::move(copy.value());
  saved->parts = w.kept();
  saved->indexed = w.indexed();
  const std::size_t bytes = sizeof *saved + saved->space->bytes() + saved->engines.size();
  return Snapshot(w.tick, bytes, std::move(saved));
}

hal::Result<Snapshot> World::snapshot_of_all() {
  hal::Result<Snapshot> taken = snapshot();
  if (!taken.ok()) return taken;
  auto saved = std::const_pointer_cast<SavedWorld>(taken.value().state_);  // nobody else has it yet
  saved->checkpoints = impl_->kept_checkpoints;
  return taken;
}

/// The stores and `parts` have come from elsewhere: what follows from them does.
void World::Impl::fit_to_state(bool was_indexed) {
  media.fit(stores());
  indexed_version = was_indexed ? stores().immovables_version : 0;
  block_trouble.assign(clamped.size(), 0);
  faults.assign(clamped.size(), {});
  said.assign(clamped.size(), {});
  excess.assign(clamped.size(), {});
  strays.clear();
}

hal::Status World::restore(const Snapshot& snapshot) {
  Impl& w = *impl_;
  const SavedWorld& saved = *snapshot.state_;
  if (saved.of != w.identity) return hal::Error{"the snapshot is of another world"};
  if (w.external != nullptr) return hal::Error{"no way back: real robots or peers take part, which cannot be put back"};
  // What hooks do to the space when their controls are put back does not count.
  const hal::Status controls = w.put_back_controls(saved.hook_controls);
  hal::Status all = saved.space->put_back(w.space, w.devices);
  if (all.ok()) all = controls;
  w.kept() = saved.parts;
  hal::Archive engines(saved.engines);
  if (hal::Status engines_back = w.remember_engines(engines); all.ok()) all = engines_back;
  w.fit_to_state(saved.indexed);
  if (saved.checkpoints) w.kept_checkpoints = *saved.checkpoints;
  for (std::size_t i = 0; i < w.hooks.size(); ++i) {
    const std::string why = w.asked(i, "restore", [&](Hook& hook) { hook.restore(saved.hooks[i]); });
    if (!why.empty()) all = hal::Error{why};
  }
  if (!all.ok()) w.fail(all.error().message);
  return all;
}

}  // namespace tandem::core
