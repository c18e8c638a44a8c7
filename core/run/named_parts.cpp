#include "core/run/named_parts.hpp"

#include "core/scenario/run_part_type.hpp"
#include "hal/plugin_call.hpp"

namespace tandem::core {
namespace {

void name_part(const void* name, std::size_t /*part*/, std::size_t /*index*/, hal::FixedText& out) noexcept {
  out << *static_cast<const std::string*>(name);
}

/// A part of a plug-in: what happens in its calls is told as its doing.
class NamedPart final : public RunPart {
 public:
  explicit NamedPart(std::string who) : who_(std::move(who)) {}
  /// Nothing where that said why, or threw.
  void make(const RunPartType& type, const Element& element, Run& run, Problems& problems) {
    const hal::PluginCall marked(&name_part, &who_);
    part_ = type.make(element, run, problems);
  }
  bool made() const noexcept { return part_ != nullptr; }
  const std::string& who() const noexcept { return who_; }

  std::string_view name() const override { return part_->name(); }
  RunTurn turn() const override { return RunTurn::Added; }
  hal::Status join(Run& run) override {
    const hal::PluginCall marked(&name_part, &who_);
    return part_->join(run);
  }
  bool before_tick(Run& run) override {
    const hal::PluginCall marked(&name_part, &who_);
    return part_->before_tick(run);
  }
  bool after_tick(Run& run) override {
    const hal::PluginCall marked(&name_part, &who_);
    (void)part_->after_tick(run);
    return true;  // pace is kept, whatever a plug-in says
  }
  void event(hal::Tick tick, const hal::Json& event) override {
    const hal::PluginCall marked(&name_part, &who_);
    part_->event(tick, event);
  }
  hal::Status finish(Run& run) override {
    const hal::PluginCall marked(&name_part, &who_);
    return part_->finish(run);
  }
  hal::Status close(Run& run) override {
    const hal::PluginCall marked(&name_part, &who_);
    return part_->close(run);
  }

 private:
  std::string who_;
  std::unique_ptr<RunPart> part_;
};

}  // namespace

void add_named_parts(Run& run, const hal::Catalog& catalog, Problems& problems) {
  for (const Element& element : run.world().scenario().run_parts) {
    const auto* const type = catalog.find<RunPartType>(element.name);
    auto part = std::make_unique<NamedPart>("part '" + element.name + "' (library '" + catalog.origin_of(type) + "')");
    const std::size_t before = problems.size();
    try {
      part->make(*type, element, run, problems);
    } catch (const std::exception& e) {
      problems.push_back(problem_at(element, part->who() + " threw: " + e.what()));
    }
    if (part->made())
      run.add(std::move(part));
    else if (!has_errors(problems, before))
      problems.push_back(problem_at(element, part->who() + " was not made, and does not say why"));
  }
}

}  // namespace tandem::core
