// The one run of ARGoS classes in this process: its world, its entities, its loop functions and user functions.
#pragma once
#include <argos3/core/simulator/loop_functions.h>
#include <argos3/core/utility/plugins/factory.h>
#include <argos3/plugins/simulator/visualizations/qt-opengl/qtopengl_user_functions.h>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compat/argos3/simulator/world_door.hpp"

namespace tandem::compat::argos3 {

/// Used by the thread that steps. Whatever the user's code throws passes through.
class Session {
 public:
  static Session& get();

  // --- a run's life, called by its hooks or by a program of one's own ---
  /// Takes the world of a run that begins, and makes an entity of everything in it. `again`: the entities are there;
  /// finds them in the world, and brings back those that loop functions had added.
  void enter(WorldDoor& world, bool again);
  /// The world is gone, or about to go: ends user code.
  void leave(const WorldDoor& world);
  /// Makes the loop functions and calls Init.
  void init_loop_functions(const ::argos::tandem_detail::SRegistration& made_by, ::argos::TConfigurationNode& tree);
  void destroy_loop_functions();
  void add_user_functions(const ::argos::tandem_detail::SRegistration& made_by, ::argos::TConfigurationNode& tree);
  void destroy_user_functions();

  // --- phases of a tick; each begins with a look at all bodies, and ends with the deletion of removed entities ---
  /// Once for all hooks.
  void begin_phase();
  void pre_step();
  void post_step();
  bool is_finished();
  void post_experiment();
  /// 0 black to 1 white.
  double floor_shade(double x_m, double y_m);

  bool entered() const noexcept { return world_ != nullptr; }
  /// @throws CARGoSException when no experiment runs
  WorldDoor& world() const;
  /// The run's, or ones that do nothing.
  ::argos::CLoopFunctions& loop_functions();
  bool has_loop_functions() const noexcept { return loop_functions_ != nullptr; }
  const std::vector<std::unique_ptr<::argos::CQTOpenGLUserFunctions>>& user_functions() const {
    return user_functions_;
  }
  /// Draws by all user functions.
  void draw();
  /// Keys that people hold down, as a text, and the id of the entity that they have selected.
  void set_keys(const std::string& keys);
  void select(const std::string& id);
  ::argos::CEntity* selected() const noexcept { return selected_; }
  void forget(const ::argos::CEntity& entity);

  bool terminated = false;
  /// A program of one's own steps the world, and asks by itself whether the experiment is finished.
  bool own_program = false;
  std::optional<std::uint32_t> wanted_seed;
  std::string file;      ///< of the experiment
  bool painted = false;  ///< loop functions paint the floor

 private:
  void end_phase();

  WorldDoor* world_ = nullptr;
  std::unique_ptr<::argos::CLoopFunctions> loop_functions_, none_;
  std::vector<std::unique_ptr<::argos::CQTOpenGLUserFunctions>> user_functions_;
  ::argos::CEntity* selected_ = nullptr;
  std::string keys_;
};

inline WorldDoor& world() {
  return Session::get().world();
}
inline bool in_world(const Body& body) {
  return body.Kind != Body::NONE && Session::get().entered() && world().there(body);
}

/// Throws a CARGoSException that names the entity and the reason.
[[noreturn]] void refuse(const std::string& who, const std::string& why);

::argos::CVector3 vector_of(const Place& place);
::argos::CQuaternion quaternion_of(const Place& place);
Place place_of(const ::argos::CVector3& position, const ::argos::CQuaternion& orientation);

}  // namespace tandem::compat::argos3

namespace argos {

/// The session's door to the space.
class CSpaceAccess {
 public:
  static void Fill(CSpace& space);
  static void FindAgain(CSpace& space);
  static void Look(CSpace& space);
  static void Sweep(CSpace& space);
  static void Clear(CSpace& space);
  /// `again`: the same run, from its start.
  static void NewRun(CSimulator& simulator, bool again);
};

}  // namespace argos
