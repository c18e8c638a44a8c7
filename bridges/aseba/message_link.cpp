#include "bridges/aseba/message_link.hpp"

namespace tandem::bridges::aseba {

const char* carrier_name(Carrier carrier) noexcept {
  switch (carrier) {
    case Carrier::Up:
      return "up";
    case Carrier::Down:
      return "down";
    case Carrier::Gone:
      return "gone";
  }
  return "";
}

}  // namespace tandem::bridges::aseba
