// Anchors of bodies, and boxes around them.
#ifndef ARGOS3_CORE_SIMULATOR_PHYSICS_ENGINE_PHYSICS_MODEL_H
#define ARGOS3_CORE_SIMULATOR_PHYSICS_ENGINE_PHYSICS_MODEL_H

#include <argos3/core/utility/datatypes/datatypes.h>
#include <argos3/core/utility/math/quaternion.h>
#include <argos3/core/utility/math/vector3.h>
#include <string>

namespace argos {

class CEmbodiedEntity;

/// Around a body, with sides along the axes of the world, in m.
struct SBoundingBox {
  CVector3 MinCorner, MaxCorner;

  SBoundingBox() {}
  SBoundingBox(const CVector3& c_min, const CVector3& c_max) : MinCorner(c_min), MaxCorner(c_max) {}
  bool Intersects(const SBoundingBox& s_other) const {
    return MinCorner.GetX() <= s_other.MaxCorner.GetX() && MaxCorner.GetX() >= s_other.MinCorner.GetX() &&
           MinCorner.GetY() <= s_other.MaxCorner.GetY() && MaxCorner.GetY() >= s_other.MinCorner.GetY() &&
           MinCorner.GetZ() <= s_other.MaxCorner.GetZ() && MaxCorner.GetZ() >= s_other.MinCorner.GetZ();
  }
};

/// A point of a body. The origin is the middle of its base. Position and orientation are those of the world when the
/// anchor was asked for, and follow the body from phase to phase after that.
struct SAnchor {
  CEmbodiedEntity& Body;
  std::string Id;
  UInt32 Index;
  CVector3 OffsetPosition;
  CQuaternion OffsetOrientation;
  CVector3 Position;
  CQuaternion Orientation;
  UInt32 InUseCount;

  SAnchor(CEmbodiedEntity& c_body, const std::string& str_id, UInt32 un_index,
          const CVector3& c_offset_position = CVector3(), const CQuaternion& c_offset_orientation = CQuaternion(),
          const CVector3& c_position = CVector3(), const CQuaternion& c_orientation = CQuaternion())
      : Body(c_body),
        Id(str_id),
        Index(un_index),
        OffsetPosition(c_offset_position),
        OffsetOrientation(c_offset_orientation),
        Position(c_position),
        Orientation(c_orientation),
        InUseCount(0) {}
};

}  // namespace argos

#endif
