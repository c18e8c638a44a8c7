// Lamps.
#ifndef TANDEM_ARGOS3_LIGHT_ENTITY_H
#define TANDEM_ARGOS3_LIGHT_ENTITY_H
#include <argos3/core/simulator/entity/positional_entity.h>
#include <argos3/plugins/simulator/entities/led_equipped_entity.h>
#include <string>

namespace argos {

class CLightEntity : public CLEDEntity {
 public:
  CLightEntity();
  CLightEntity(const std::string& id, const CVector3& position, const CColor& color, Real intensity);
  ~CLightEntity() override;

  Real GetIntensity() const { return m_fIntensity; }
  void SetIntensity(Real intensity);
  void SetColor(const CColor& color) override;
  void MoveTo(const CVector3& position, const CQuaternion& orientation) override;
  /// A disabled lamp is dark.
  void SetEnabled(bool enabled) override;
  void Reset() override;
  std::string GetTypeDescription() const override;
  CAny AsAny() override;
  void JoinWorld() override;
  void LeaveWorld() override;
  bool FindInWorld() override;

 private:
  void WriteWorld();
  Real m_fIntensity;
  size_t m_unLight;
  bool m_bInWorld = false;
};

}  // namespace argos

#endif
