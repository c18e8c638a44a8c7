// Controllers of robots, as loop functions reach them.
#ifndef ARGOS3_CORE_SIMULATOR_ENTITY_CONTROLLABLE_ENTITY_H
#define ARGOS3_CORE_SIMULATOR_ENTITY_CONTROLLABLE_ENTITY_H

#include <argos3/core/control_interface/ci_controller.h>
#include <argos3/core/simulator/entity/entity.h>
#include <map>
#include <string>
#include <vector>

namespace argos {

class CControllableEntity : public CEntity {
 public:
  typedef std::vector<CControllableEntity*> TVector;
  typedef std::map<std::string, CControllableEntity*> TMap;

  explicit CControllableEntity(CComposableEntity* pc_parent);
  CControllableEntity(CComposableEntity* pc_parent, const std::string& str_id);
  ~CControllableEntity() override;

  /// The robot's controller, also across resets the same object. Throws: the robot is not in the space, or its
  /// controller is no ARGoS controller.
  CCI_Controller& GetController();
  const CCI_Controller& GetController() const;
  /// Before the robot is added: the id of its configuration in the experiment file.
  void SetController(const std::string& str_controller_id) { m_strConfiguration = str_controller_id; }
  const std::string& GetControllerId() const { return m_strConfiguration; }
  std::string GetTypeDescription() const override;
  /// A robot whose controller is disabled stands and does not step.
  void SetEnabled(bool b_enabled) override;
  CAny AsAny() override;

  ARGOS3_NO_FUNCTION(Sense, "the run senses for all robots")
  ARGOS3_NO_FUNCTION(ControlStep, "the run steps all robots; a robot whose controllable entity is disabled is left out")
  ARGOS3_NO_FUNCTION(Act, "the run acts for all robots")
  ARGOS3_NO_FUNCTION(GetActuators, "ask the controller: GetController().GetAllActuators()")
  ARGOS3_NO_FUNCTION(GetSensors, "ask the controller: GetController().GetAllSensors()")
  ARGOS3_NO_FUNCTION(GetCheckedRays, "switch on the layer of the sensor in the window")
  ARGOS3_NO_FUNCTION(GetIntersectionPoints, "switch on the layer of the sensor in the window")

 private:
  std::string m_strConfiguration;
};

}  // namespace argos

#endif
