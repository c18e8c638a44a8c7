// The floor of the arena.
#ifndef ARGOS3_CORE_SIMULATOR_ENTITY_FLOOR_ENTITY_H
#define ARGOS3_CORE_SIMULATOR_ENTITY_FLOOR_ENTITY_H

#include <argos3/core/simulator/entity/entity.h>
#include <argos3/core/utility/datatypes/color.h>
#include <argos3/core/utility/math/vector2.h>
#include <argos3/core/utility/math/vector3.h>

namespace argos {

class CFloorEntity : public CEntity {
 public:
  explicit CFloorEntity(const std::string& str_id = "floor");
  ~CFloorEntity() override;

  /// Where loop functions paint, their shade; else the shade of grey that ground sensors see.
  CColor GetColorAtPoint(Real f_x, Real f_y);
  bool HasChanged() const;
  /// Has GetFloorColor asked for the whole floor again, before sensors look at it next.
  void SetChanged();
  void ClearChanged() {}
  std::string GetTypeDescription() const override;
  CAny AsAny() override;

  ARGOS3_NO_FUNCTION(SaveAsImage, "tandem run --picture writes one")

 private:
  UInt32 m_unChangedAt = 0;
  bool m_bChanged = false;
};

}  // namespace argos

#endif
