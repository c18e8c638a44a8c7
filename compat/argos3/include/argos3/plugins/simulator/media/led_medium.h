// The medium of LEDs.
#ifndef TANDEM_ARGOS3_LED_MEDIUM_H
#define TANDEM_ARGOS3_LED_MEDIUM_H
#include <argos3/core/simulator/medium/medium.h>

namespace argos {

class CLEDMedium : public CMedium {
 public:
  explicit CLEDMedium(const std::string& id) : CMedium(id) {}
  ~CLEDMedium() override;
};

}  // namespace argos

#endif
