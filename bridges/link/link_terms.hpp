// The terms on which a link is opened: the permitted speakers.
#pragma once
#include <functional>
#include <memory>
#include <utility>

#include "bridges/send_permit.hpp"
#include "hal/result.hpp"

namespace tandem::bridges {

struct LinkTerms {
  /// Asked before each write. A link whose permit was withdrawn has hung up, for good.
  SendPermit permit = {};
  /// Also where the device is held already: a guardian speaks while its frozen hub still has it open.
  bool beside = false;
};

/// Why a link cannot be opened at present.
inline hal::Error not_permitted() {
  return hal::Error{"this program was frozen, and its guardian process is stopping the robot"};
}

/// Opens with `opener` only while the permit is granted; a `Permitted` guards what was opened.
template <class Permitted, class Link>
std::function<hal::Result<std::unique_ptr<Link>>()> permitted_by(
    std::function<hal::Result<std::unique_ptr<Link>>()> opener, SendPermit permit) {
  if (!permit.real()) return opener;
  return [opener = std::move(opener), permit]() -> hal::Result<std::unique_ptr<Link>> {
    const std::uint32_t turn = permit.turn();
    if (!permit.granted_since(turn)) return not_permitted();
    auto link = opener();
    if (!link.ok()) return link;
    return std::unique_ptr<Link>(std::make_unique<Permitted>(std::move(link).value(), permit, turn));
  };
}

}  // namespace tandem::bridges
