#include "compat/argos3/simulator/session.hpp"

#include <algorithm>
#include <iostream>

#include "compat/argos3/facade/context.hpp"
#include "compat/argos3/facade/controllers.hpp"

namespace tandem::compat::argos3 {
namespace {

/// Text of loop functions and user functions goes where that of ARGoS goes.
class LoopContext final : public Context {
 public:
  void tell(bool error, std::string_view text) override { (error ? std::cerr : std::cout) << text << std::endl; }
};
/// Of this run; another one begins with generators of its own. Outlives static objects of libraries.
std::unique_ptr<LoopContext>& loop_context_of_run() {
  static auto* const context = new std::unique_ptr<LoopContext>(new LoopContext);
  return *context;
}
Context& loop_context() {
  return *loop_context_of_run();
}

/// Calls Destroy; its exception is told, since nobody is there to take it.
template <class Functions>
void destroy(Functions& functions, const std::string& what) {
  const ContextScope scope(loop_context());
  try {
    functions.Destroy();
  } catch (const std::exception& e) {
    loop_context().tell(true, "error: in Destroy() of the " + what + ": " + e.what());
  } catch (...) {
    loop_context().tell(true, "error: in Destroy() of the " + what + ": an exception of unknown type");
  }
}

}  // namespace

void refuse(const std::string& who, const std::string& why){THROW_ARGOSEXCEPTION("\"" << who << "\": " << why)}

argos::CVector3 vector_of(const Place& place) {
  return {place.x_m, place.y_m, place.z_m};
}
argos::CQuaternion quaternion_of(const Place& place) {
  return {place.w, place.x, place.y, place.z};
}
Place place_of(const argos::CVector3& p, const argos::CQuaternion& q) {
  return {p.GetX(), p.GetY(), p.GetZ(), q.GetW(), q.GetX(), q.GetY(), q.GetZ()};
}

Session& Session::get() {
  static Session* const session = new Session;  // outlives static objects of libraries
  return *session;
}

WorldDoor& Session::world() const {
  if (world_ == nullptr)
    THROW_ARGOSEXCEPTION(
        "no experiment runs that this can be asked of: the file needs <loop_functions>, or the program LoadExperiment")
  return *world_;
}

void Session::enter(WorldDoor& world, bool again) {
  world_ = &world;
  terminated = false;
  if (!again) loop_context_of_run() = std::make_unique<LoopContext>();
  loop_context().set_seed(world.seed());
  set_run_seed(world.seed());
  argos::CSimulator& simulator = argos::CSimulator::GetInstance();
  const ContextScope scope(loop_context());
  argos::CSpaceAccess::NewRun(simulator, again);
  if (!again) return argos::CSpaceAccess::Clear(simulator.GetSpace());
  argos::CSpaceAccess::Sweep(simulator.GetSpace());
  argos::CSpaceAccess::FindAgain(simulator.GetSpace());
  for (const auto& functions : user_functions_) functions->Reset();
  if (loop_functions_ != nullptr) loop_functions_->Reset();
  end_phase();
}

void Session::leave(const WorldDoor& world) {
  if (world_ != &world) return;
  destroy_user_functions();
  destroy_loop_functions();
  selected_ = nullptr;
  keys_.clear();
  argos::CSpaceAccess::Clear(argos::CSimulator::GetInstance().GetSpace());
  world_ = nullptr;
  painted = false;
}

void Session::begin_phase() {
  if (!entered()) return;
  argos::CSpaceAccess::Look(argos::CSimulator::GetInstance().GetSpace());
}
void Session::end_phase() {
  argos::CSpaceAccess::Sweep(argos::CSimulator::GetInstance().GetSpace());
}

argos::CLoopFunctions& Session::loop_functions() {
  if (loop_functions_ != nullptr) return *loop_functions_;
  if (none_ == nullptr) none_ = std::make_unique<argos::CLoopFunctions>();
  return *none_;
}

void Session::init_loop_functions(const ::argos::tandem_detail::SRegistration& made_by,
                                  argos::TConfigurationNode& tree) {
  const ContextScope scope(loop_context());
  loop_functions_.reset(static_cast<argos::CLoopFunctions*>(made_by.Create()));
  try {
    loop_functions_->Init(tree);
  } catch (...) {
    loop_functions_.reset();
    throw;
  }
  end_phase();
}
void Session::destroy_loop_functions() {
  if (loop_functions_ == nullptr) return;
  destroy(*loop_functions_, "loop functions");
  loop_functions_.reset();
}

void Session::add_user_functions(const ::argos::tandem_detail::SRegistration& made_by,
                                 argos::TConfigurationNode& tree) {
  const ContextScope scope(loop_context());
  user_functions_.emplace_back(static_cast<argos::CQTOpenGLUserFunctions*>(made_by.Create()));
  try {
    user_functions_.back()->Init(tree);
  } catch (...) {
    user_functions_.pop_back();
    throw;
  }
}
void Session::destroy_user_functions() {
  for (const auto& functions : user_functions_) destroy(*functions, "user functions");
  user_functions_.clear();
}

void Session::pre_step() {
  const ContextScope scope(loop_context());
  loop_functions().PreStep();
  end_phase();
}
void Session::post_step() {
  const ContextScope scope(loop_context());
  loop_functions().PostStep();
  end_phase();
}
bool Session::is_finished() {
  if (terminated) return true;
  const ContextScope scope(loop_context());
  return loop_functions().IsExperimentFinished();
}
void Session::post_experiment() {
  const ContextScope scope(loop_context());
  loop_functions().PostExperiment();
  end_phase();
}
double Session::floor_shade(double x_m, double y_m) {
  const ContextScope scope(loop_context());
  return loop_functions().GetFloorColor(argos::CVector2(x_m, y_m)).ToGrayScale() / 255.0;
}

void Session::draw() {
  if (user_functions_.empty()) return;
  const ContextScope scope(loop_context());
  for (const auto& functions : user_functions_) functions->DrawAll();
  end_phase();
}

// --- people ---

void Session::set_keys(const std::string& keys) {
  const ContextScope scope(loop_context());
  const std::string before = std::exchange(keys_, keys);
  const auto differ = [](const std::string& of, const std::string& from, auto&& call) {
    for (const char key : of) {
      if (from.find(key) == std::string::npos) call(QKeyEvent(key));
    }
  };
  for (const auto& functions : user_functions_) {
    differ(before, keys, [&](QKeyEvent event) { functions->KeyReleased(&event); });
    differ(keys, before, [&](QKeyEvent event) { functions->KeyPressed(&event); });
  }
}

void Session::select(const std::string& id) {
  const ContextScope scope(loop_context());
  argos::CEntity::TMap& all = argos::CSimulator::GetInstance().GetSpace().GetEntityMapPerId();
  const auto found = all.find(id);
  argos::CEntity* const wanted = found == all.end() ? nullptr : found->second;
  if (wanted == selected_) return;
  argos::CEntity* const before = std::exchange(selected_, wanted);
  for (const auto& functions : user_functions_) {
    if (before != nullptr) functions->EntityDeselected(*before);
    if (wanted != nullptr) functions->EntitySelected(*wanted);
  }
}

void Session::forget(const argos::CEntity& entity) {
  if (selected_ == &entity) selected_ = nullptr;
}

}  // namespace tandem::compat::argos3
