#include "compat/argos3/simulator/hooks.hpp"

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "compat/argos3/facade/configuration.hpp"
#include "compat/argos3/facade/controllers.hpp"
#include "compat/argos3/simulator/session.hpp"
#include "compat/argos3/simulator/world_adapter.hpp"

namespace tandem::compat::argos3 {
namespace {

using argos::tandem_detail::SRegistration;

/// The world of this process' run, shared by its hooks.
std::shared_ptr<WorldAdapter> shared_world() {
  static std::weak_ptr<WorldAdapter> last;
  std::shared_ptr<WorldAdapter> world = last.lock();
  if (world == nullptr) last = world = std::make_shared<WorldAdapter>();
  return world;
}

/// What hooks of both kinds do: lets the session see the world.
class ArgosHook : public core::Hook {
  using Phase = WorldAdapter::Phase;

 public:
  ArgosHook(const SRegistration& made_by, const core::Element& options)
      : made_by_(made_by), tree_(to_node(options, true)), file_(options.file), world_(shared_world()) {
    world_->begin_afresh();
  }
  ~ArgosHook() override {
    if (world_.use_count() > 1) return;
    Session::get().leave(*world_);
    hold_controllers(false);
    end_left_controllers();
  }

  void before_run(core::HookContext& c) override {
    if (entered_ || !Session::get().entered()) Session::get().file = file_;
    if (!world_->may_be(c.space))
      throw std::runtime_error(
          "another run of ARGoS classes goes on in this process, which they have one of: start another process, as "
          "sweeps do");
    look(c, c.tick, Phase::Other);
    if (const auto begins = world_->begins(); begins != WorldAdapter::Begins::Goes)
      Session::get().enter(*world_, begins == WorldAdapter::Begins::Again);
    if (!std::exchange(entered_, true)) begin(made_by_, *tree_);
  }
  void before_step(core::HookContext& c) override { look(c, c.tick + 1, Phase::Other); }
  void before_sense(core::HookContext& c) override { look(c, c.tick + 1, Phase::Sense); }
  void after_step(core::HookContext& c) override { look(c, c.tick + 1, Phase::Stepped); }
  bool is_done(core::HookContext& c) override {
    look(c, c.tick, Phase::Other);
    return false;
  }
  void after_run(core::HookContext& c) override { look(c, c.tick, Phase::Other); }
  bool reset(std::uint64_t) override {
    world_->begin_again();
    return true;
  }

 protected:
  virtual void begin(const SRegistration& made_by, ::argos::TConfigurationNode& tree) = 0;

  bool sees(const core::HookContext& c) const noexcept { return world_->may_be(c.space); }

 private:
  /// The first hook that is called after things have moved has the session look at all bodies.
  void look(core::HookContext& c, hal::Tick clock, Phase phase) {
    const bool begins = world_->look(c, static_cast<std::uint32_t>(clock), phase);
    if (begins && phase != Phase::Other) Session::get().begin_phase();
  }

  const SRegistration& made_by_;
  std::unique_ptr<ticpp::Element> tree_;
  std::string file_;
  std::shared_ptr<WorldAdapter> world_;
  bool entered_ = false;
};

class LoopFunctions final : public ArgosHook {
 public:
  LoopFunctions(const SRegistration& made_by, const core::Element& options) : ArgosHook(made_by, options) {
    hold_controllers(true);  // users keep pointers to them
  }
  ~LoopFunctions() override { Session::get().destroy_loop_functions(); }

  void before_sense(core::HookContext& c) override {
    ArgosHook::before_sense(c);
    Session::get().pre_step();
  }
  void after_step(core::HookContext& c) override {
    ArgosHook::after_step(c);
    Session::get().post_step();
  }
  bool is_done(core::HookContext& c) override {
    ArgosHook::is_done(c);
    return !Session::get().own_program && Session::get().is_finished();
  }
  void after_run(core::HookContext& c) override {
    ArgosHook::after_run(c);
    if (!Session::get().own_program) Session::get().post_experiment();
  }
  std::optional<double> floor(double x_m, double y_m) override { return Session::get().floor_shade(x_m, y_m); }

 protected:
  void begin(const SRegistration& made_by, ::argos::TConfigurationNode& tree) override {
    Session::get().init_loop_functions(made_by, tree);
  }
};

class UserFunctions final : public ArgosHook {
 public:
  UserFunctions(const SRegistration& made_by, const core::Element& options) : ArgosHook(made_by, options) {
    hold_controllers(true);
  }
  ~UserFunctions() override { Session::get().destroy_user_functions(); }

  void before_run(core::HookContext& c) override {
    ArgosHook::before_run(c);
    Session::get().draw();
  }
  void after_step(core::HookContext& c) override {
    ArgosHook::after_step(c);
    Session::get().draw();
  }
  bool is_done(core::HookContext& c) override {
    ArgosHook::is_done(c);
    return Session::get().terminated && !Session::get().own_program;
  }
  void controls(core::HookContext& c, hal::Controls& controls) override {
    if (controls.text("selected", selected_, "Id of the entity that user functions take as selected."))
      Session::get().select(selected_);
    if (controls.text("keys", keys_, "Keys that are held down, for user functions: \"ij\"."))
      Session::get().set_keys(keys_);
    ArgosHook::controls(c, controls);
  }

 protected:
  void begin(const SRegistration& made_by, ::argos::TConfigurationNode& tree) override {
    Session::get().add_user_functions(made_by, tree);
  }

 private:
  std::string selected_, keys_;
};

/// Does nothing but let CSimulator see the world, for controllers that ask it for the time, say. Of several worlds in a
/// process it sees the first.
class Look final : public ArgosHook {
 public:
  using ArgosHook::ArgosHook;
  void before_run(core::HookContext& c) override {
    if (sees(c)) ArgosHook::before_run(c);
  }
  void before_step(core::HookContext& c) override {
    if (sees(c)) ArgosHook::before_step(c);
  }
  void before_sense(core::HookContext& c) override {
    if (sees(c)) ArgosHook::before_sense(c);
  }
  void after_step(core::HookContext& c) override {
    if (sees(c)) ArgosHook::after_step(c);
  }
  bool is_done(core::HookContext& c) override { return sees(c) && ArgosHook::is_done(c); }
  void after_run(core::HookContext& c) override {
    if (sees(c)) ArgosHook::after_run(c);
  }
  bool remember(hal::Archive&) override { return true; }

 protected:
  void begin(const SRegistration&, ::argos::TConfigurationNode&) override {}
};

/// The table of a class and the texts that it names.
struct NamedType {
  std::string name, summary;
  core::HookType type;
};
using Types = ClassTables<NamedType>;

struct MakeHook {
  template <std::size_t kNumber>
  static std::unique_ptr<core::Hook> call(const core::Element& options, core::Problems&) {
    const SRegistration& made_by = Types::registration(kNumber);
    if (std::string_view(made_by.Kind) == "loop functions") return std::make_unique<LoopFunctions>(made_by, options);
    return std::make_unique<UserFunctions>(made_by, options);
  }
};
constexpr auto kMakers = functions_by_number<MakeHook, Types::kMost>();

std::unique_ptr<core::Hook> make_look(const core::Element& options, core::Problems&) {
  static const SRegistration none = {"", "", "", nullptr, nullptr};
  return std::make_unique<Look>(none, options);
}

}  // namespace

const core::HookType& look_hook() {
  static const core::HookType type = {"argos3", "Lets ARGoS' CSimulator see the world; does nothing else.", &make_look};
  return type;
}

void register_hooks(const std::vector<const SRegistration*>& all, hal::Registrar& registrar) {
  for (const SRegistration* const one : all) {
    const std::string_view kind = one->Kind;
    if (kind != "loop functions" && kind != "user functions") continue;
    registrar.add(Types::of(*one, [&](NamedType& named, std::size_t number) {
                    named.name = (kind == "user functions" ? "qt-opengl " : "") + std::string(one->Label);
                    named.summary = "ARGoS " + std::string(kind) + " '" + one->ClassName + "'.";
                    named.type.name = named.name;
                    named.type.summary = named.summary;
                    named.type.make = kMakers[number];
                  }).type);
  }
}

}  // namespace tandem::compat::argos3
