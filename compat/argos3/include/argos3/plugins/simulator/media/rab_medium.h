// The medium of range-and-bearing.
#ifndef TANDEM_ARGOS3_RAB_MEDIUM_H
#define TANDEM_ARGOS3_RAB_MEDIUM_H
#include <argos3/core/simulator/medium/medium.h>
#include <argos3/plugins/simulator/entities/rab_equipped_entity.h>

namespace argos {

class CRABMedium : public CMedium {
 public:
  explicit CRABMedium(const std::string& id) : CMedium(id) {}
  ~CRABMedium() override;
  /// Robots whose messages this one could hear, were all of them sending: those in range of each other, whatever stands
  /// between.
  const CRABEquippedEntity::TSet& GetRABsCommunicatingWith(CRABEquippedEntity& entity) const;
};

}  // namespace argos

#endif
