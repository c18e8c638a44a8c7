// Entities: everything that stands in the space, and the parts that it is composed of.
#ifndef ARGOS3_CORE_SIMULATOR_ENTITY_ENTITY_H
#define ARGOS3_CORE_SIMULATOR_ENTITY_ENTITY_H

#include <argos3/core/simulator/not_carried_over.h>
#include <argos3/core/utility/configuration/argos_configuration.h>
#include <argos3/core/utility/configuration/base_configurable_resource.h>
#include <argos3/core/utility/datatypes/any.h>
#include <argos3/core/utility/datatypes/datatypes.h>
#include <map>
#include <string>
#include <sys/types.h>
#include <unordered_map>
#include <vector>

namespace argos {

class CComposableEntity;

/// A thing in the space. What Tandem keeps of it is asked for when it is looked at; the object itself lives until the
/// end of the phase in which it is removed.
class CEntity : public CBaseConfigurableResource {
 public:
  typedef std::vector<CEntity*> TVector;
  typedef std::unordered_map<std::string, CEntity*> TMap;
  typedef std::multimap<std::string, CEntity*> TMultiMap;

  explicit CEntity(CComposableEntity* pc_parent);
  CEntity(CComposableEntity* pc_parent, const std::string& str_id);
  virtual ~CEntity();
  CEntity(const CEntity&) = delete;
  CEntity& operator=(const CEntity&) = delete;

  /// Throws: entities come from constructors or from the experiment file.
  virtual void Init(TConfigurationNode& t_tree);
  virtual void Reset();
  virtual void Destroy();
  virtual void Update();

  const std::string& GetId() const { return m_strId; }
  /// Ids of the parents, each followed by a dot.
  std::string GetContext() const;
  bool HasParent() const { return m_pcParent != nullptr; }
  CEntity& GetRootEntity();
  const CEntity& GetRootEntity() const;
  /// Throws: it has none.
  CComposableEntity& GetParent();
  const CComposableEntity& GetParent() const;
  void SetParent(CComposableEntity& c_parent) { m_pcParent = &c_parent; }
  virtual std::string GetTypeDescription() const;
  ssize_t GetIndex() const { return m_nIndex; }
  void SetIndex(ssize_t n_index) { m_nIndex = n_index; }
  bool IsEnabled() const { return m_bEnabled; }
  void Enable() { SetEnabled(true); }
  void Disable() { SetEnabled(false); }
  virtual void SetEnabled(bool b_enabled);

  // --- for the space ---
  /// Itself, as a pointer to its class.
  virtual CAny AsAny();
  /// Brings it into the world, at the place that it was constructed with or last had at a reset; throws.
  virtual void JoinWorld();
  /// Takes it out of the world.
  virtual void LeaveWorld();
  /// After a reset: finds it in the world by its id. False: not there.
  virtual bool FindInWorld();

 protected:
  bool m_bEnabled = true;

 private:
  CComposableEntity* m_pcParent;
  std::string m_strId;
  ssize_t m_nIndex = -1;
};

struct SEntityComparator {
  bool operator()(const CEntity* pc_a, const CEntity* pc_b) const { return pc_a->GetIndex() < pc_b->GetIndex(); }
  bool operator()(const CEntity& c_a, const CEntity& c_b) const { return c_a.GetIndex() < c_b.GetIndex(); }
};

}  // namespace argos

#define ENABLE_VTABLE()                                                                           \
  ARGOS3_NOT_CARRIED_OVER(                                                                        \
      "own classes of entities (ENABLE_VTABLE, REGISTER_ENTITY): describe a robot kind instead, " \
      "docs/robot-files.md, or compose boxes and cylinders")
#define REGISTER_ENTITY(...) ENABLE_VTABLE()

#endif
