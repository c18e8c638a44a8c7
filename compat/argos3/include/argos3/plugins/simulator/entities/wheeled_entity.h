// The wheels of a robot.
#ifndef TANDEM_ARGOS3_WHEELED_ENTITY_H
#define TANDEM_ARGOS3_WHEELED_ENTITY_H
#include <argos3/core/simulator/entity/entity.h>
#include <argos3/core/utility/math/vector3.h>

namespace argos {

/// Left and right.
class CWheeledEntity : public CEntity {
 public:
  CWheeledEntity(CComposableEntity* parent, const std::string& id, size_t wheels);
  ~CWheeledEntity() override;

  size_t GetNumWheels() const { return 2; }
  const CVector3& GetWheelPosition(size_t number) const;
  const CVector3* GetWheelPositions() const;
  /// The commanded speeds, in m/s.
  Real GetWheelVelocity(size_t number) const;
  const Real* GetWheelVelocities() const;
  /// Until the controller commands others.
  void SetVelocities(Real* speeds);
  std::string GetTypeDescription() const override;
  CAny AsAny() override;

  ARGOS3_NO_FUNCTION(SetWheel, "wheels are those of the robot's kind: docs/robot-files.md")
  ARGOS3_NO_FUNCTION(GetWheelRadius, "Tandem's drives are described by the distance of the wheels")
  ARGOS3_NO_FUNCTION(GetWheelRadia, "Tandem's drives are described by the distance of the wheels")

 private:
  mutable CVector3 m_cPositions[2];
  mutable Real m_fVelocities[2];
};

}  // namespace argos

#endif
