// Entities that are composed of others: robots, boxes, cylinders.
#ifndef ARGOS3_CORE_SIMULATOR_ENTITY_COMPOSABLE_ENTITY_H
#define ARGOS3_CORE_SIMULATOR_ENTITY_COMPOSABLE_ENTITY_H

#include <argos3/core/simulator/entity/entity.h>
#include <argos3/core/utility/configuration/argos_exception.h>

namespace argos {

/// Owns its components. They are named by type ("body"), or by type and id ("body[body_0]").
class CComposableEntity : public CEntity {
 public:
  explicit CComposableEntity(CComposableEntity* pc_parent);
  CComposableEntity(CComposableEntity* pc_parent, const std::string& str_id);
  ~CComposableEntity() override;

  void Reset() override;
  void Update() override;
  std::string GetTypeDescription() const override;
  void SetEnabled(bool b_enabled) override;
  virtual void UpdateComponents();

  /// Takes the component over.
  void AddComponent(CEntity& c_component);
  /// Gives it back, to be deleted by the caller. Throws: there is none.
  CEntity& RemoveComponent(const std::string& str_component);
  /// Throws, and lists the components that there are.
  CEntity& GetComponent(const std::string& str_component);
  template <class E>
  E& GetComponent(const std::string& str_component) {
    E* const component = dynamic_cast<E*>(&GetComponent(str_component));
    if (component == nullptr)
      THROW_ARGOSEXCEPTION("The component \"" << str_component << "\" of entity \"" << GetId()
                                              << "\" is of another class than the one it is asked for as");
    return *component;
  }
  bool HasComponent(const std::string& str_component);
  CEntity::TMultiMap::iterator FindComponent(const std::string& str_component);
  CEntity::TMultiMap& GetComponentMap() { return m_mapComponents; }
  CEntity::TVector& GetComponentVector() { return m_vecComponents; }

  CAny AsAny() override;

 private:
  CEntity::TMultiMap m_mapComponents;
  CEntity::TVector m_vecComponents;
};

}  // namespace argos

#endif
