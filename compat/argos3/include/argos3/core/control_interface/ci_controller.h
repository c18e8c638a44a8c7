// Base of all controllers, and the macro that registers them.
#ifndef TANDEM_ARGOS3_CI_CONTROLLER_H
#define TANDEM_ARGOS3_CI_CONTROLLER_H
#include <map>
#include <string>
#include <typeinfo>

#include <argos3/core/control_interface/ci_actuator.h>
#include <argos3/core/control_interface/ci_sensor.h>
#include <argos3/core/utility/configuration/argos_exception.h>
#include <argos3/core/utility/configuration/base_configurable_resource.h>
#include <argos3/core/utility/datatypes/datatypes.h>
#include <argos3/core/utility/plugins/factory.h>

namespace argos {

/// A robot's control program. Init runs once, when its robot is made; ControlStep in every tick; Reset when the
/// experiment begins anew; Destroy at the end.
class CCI_Controller : public CBaseConfigurableResource {
 public:
  CCI_Controller();
  virtual ~CCI_Controller();

  virtual void Init(TConfigurationNode&) {}
  virtual void ControlStep() {}
  virtual void Reset() {}
  virtual void Destroy() {}

  const std::string& GetId() const { return m_strId; }
  void SetId(const std::string& id) { m_strId = id; }

  /// The device of that name in the experiment file. It lives as long as the robot.
  /// @throws CARGoSException when the file lists none, or it is of another class
  template <typename ACTUATOR_IMPL>
  ACTUATOR_IMPL* GetActuator(const std::string& name) {
    ACTUATOR_IMPL* const found = dynamic_cast<ACTUATOR_IMPL*>(FindActuator(name));
    if (found == nullptr) WrongDevice("actuator", name, typeid(ACTUATOR_IMPL));
    return found;
  }
  template <typename SENSOR_IMPL>
  SENSOR_IMPL* GetSensor(const std::string& name) {
    SENSOR_IMPL* const found = dynamic_cast<SENSOR_IMPL*>(FindSensor(name));
    if (found == nullptr) WrongDevice("sensor", name, typeid(SENSOR_IMPL));
    return found;
  }
  bool HasActuator(const std::string& name) const { return m_mapActuators.count(name) != 0; }
  bool HasSensor(const std::string& name) const { return m_mapSensors.count(name) != 0; }
  CCI_Actuator::TMap& GetAllActuators() { return m_mapActuators; }
  CCI_Sensor::TMap& GetAllSensors();
  void AddActuator(const std::string& name, CCI_Actuator* actuator) { m_mapActuators[name] = actuator; }
  void AddSensor(const std::string& name, CCI_Sensor* sensor) { m_mapSensors[name] = sensor; }

 protected:
  CCI_Actuator::TMap m_mapActuators;
  CCI_Sensor::TMap m_mapSensors;
  std::string m_strId;

 private:
  CCI_Actuator* FindActuator(const std::string& name) const;  // throws when there is none
  CCI_Sensor* FindSensor(const std::string& name) const;
  [[noreturn]] void WrongDevice(const char* role, const std::string& name, const std::type_info& asked) const;
};

}  // namespace argos

#define REGISTER_CONTROLLER(CLASSNAME, LABEL) \
  TANDEM_ARGOS3_REGISTER("controller", ::argos::CCI_Controller, CLASSNAME, LABEL, __COUNTER__)

#endif
