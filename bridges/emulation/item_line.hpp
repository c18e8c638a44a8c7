// Interface of the line from an emulated robot to its hosts, where it carries whole messages or frames.
#pragma once
#include <poll.h>
#include <string>
#include <vector>

#include "hal/result.hpp"
#include "hal/time.hpp"

namespace tandem::bridges {

/// Nothing here blocks.
template <class Item>
class ItemLine {
 public:
  virtual ~ItemLine() = default;
  /// What is to be waited for.
  virtual void add_polls(std::vector<pollfd>& polls) const = 0;
  /// Takes in what hosts have sent, or a part of it. Errors: the line is gone for good.
  virtual hal::Status take(hal::TimeNs now, std::vector<Item>& from_hosts) = 0;
  /// Sends to every host; what cannot go at once waits for `flush`.
  virtual void tell(const Item& item, hal::TimeNs now) = 0;
  virtual void flush(hal::TimeNs now) = 0;
  /// For people: what a host opens.
  virtual const std::string& path() const = 0;
  /// LINK text that opens the same line again.
  virtual const std::string& link() const = 0;
};

}  // namespace tandem::bridges
