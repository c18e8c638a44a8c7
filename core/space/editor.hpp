// Structural changes of a running space that hooks ask for, and the interface that carries them out.
#pragma once
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "core/space/body_key.hpp"
#include "core/space/ids.hpp"
#include "core/space/joint.hpp"
#include "core/space/pose.hpp"
#include "hal/result.hpp"

namespace tandem::core {

struct Object;

/// A robot to be added. Battery and radio are those of the file's first robots of that kind and configuration; the
/// file's defaults where it has none.
struct NewRobot {
  /// As the element in experiment files; empty: that of the file's first robot with this configuration, or of its
  /// first.
  std::string kind = {};
  std::string id;          ///< no robot, object, light or sound has or had it
  std::string controller;  ///< id of a configuration of the file
  Pose pose = {};
  /// Parameters that replace those of the configuration, as they would stand in the file: {"speed", "5 cm/s"}.
  std::vector<std::pair<std::string, std::string>> params = {};
  bool may_overlap = false;  ///< its place may be occupied: engines then part the bodies, as after `set_pose`
};

/// In W.
struct Velocity {
  std::array<double, 3> v_m_s{};
  std::array<double, 3> w_rad_s{};
};

/// A robot or an object, where a function takes either.
struct BodyId {
  BodyId(RobotId id) : robot(id) {}    // NOLINT(google-explicit-constructor)
  BodyId(ObjectId id) : object(id) {}  // NOLINT(google-explicit-constructor)
  RobotId robot;
  ObjectId object;
};

/// Makes robots and objects and finds their regions: what a space cannot do by itself. Each function is explained at
/// the one of the same name in Space.
class Editor {
 public:
  virtual ~Editor() = default;

  virtual hal::Result<RobotId> add_robot(const NewRobot& wanted) = 0;
  virtual hal::Result<ObjectId> add_object(const Object& wanted) = 0;
  virtual hal::Status set_object(ObjectId object, const Object& changed) = 0;
  /// Of a body that is there, under its key.
  virtual hal::Status room_for(BodyKey body, const Pose& pose) = 0;
  /// Bodies that are there, under their keys; the point in W.
  virtual hal::Result<JointId> join(BodyKey a, BodyKey b, const std::array<double, 3>& p_W, const JointForm& form) = 0;
};

}  // namespace tandem::core
