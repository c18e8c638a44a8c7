// The range-and-bearing board of a robot.
#ifndef TANDEM_ARGOS3_RAB_EQUIPPED_ENTITY_H
#define TANDEM_ARGOS3_RAB_EQUIPPED_ENTITY_H
#include <argos3/core/simulator/entity/positional_entity.h>
#include <argos3/core/simulator/physics_engine/physics_model.h>
#include <argos3/core/utility/datatypes/byte_array.h>
#include <argos3/core/utility/datatypes/set.h>
#include <map>
#include <vector>

namespace argos {

class CEmbodiedEntity;

/// What the robot sends is that of its range-and-bearing actuator; without it in the configuration it sends nothing.
class CRABEquippedEntity : public CPositionalEntity {
 public:
  typedef std::vector<CRABEquippedEntity*> TVector;
  typedef std::map<std::string, CRABEquippedEntity*> TMap;
  typedef CSet<CRABEquippedEntity*> TSet;

  explicit CRABEquippedEntity(CComposableEntity* parent);
  ~CRABEquippedEntity() override;

  CEmbodiedEntity& GetEntityBody();
  /// Bytes.
  size_t GetMsgSize() const;
  /// What the robot sends now.
  CByteArray& GetData();
  void SetData(const CByteArray& data);
  void ClearData();
  /// In m.
  Real GetRange() const;
  const SAnchor& GetAnchor() const;
  std::string GetTypeDescription() const override;
  CAny AsAny() override;

  ARGOS3_NO_FUNCTION(SetRange, "set rab_range of the robots in the experiment file")
  ARGOS3_NO_FUNCTION(GetMedium, "Tandem's medium carries the messages")
  ARGOS3_NO_FUNCTION(SetMedium, "name the medium in the experiment file")

 private:
  friend class CRABMedium;
  mutable CByteArray m_cData;
  TSet m_tNear;  // of the medium
};

}  // namespace argos

#endif
