// TCP port to which others connect: hosts of an emulated robot, peers of a run in lock-step.
#pragma once
#include <memory>
#include <string>
#include <string_view>

#include "hal/result.hpp"

namespace tandem::bridges {

/// A TCP port that listens. Nothing here blocks.
class Listener {
 public:
  /// `endpoint`: "PORT", on this computer alone, or "ADDRESS:PORT" (0.0.0.0 for all of its networks); port 0 is any
  /// that is free. `scheme`: what stands before it in a LINK text, and `host_scheme` in the text that a host writes,
  /// for messages and `path`. Errors: not a port, no such address, it cannot be listened at.
  static hal::Result<std::unique_ptr<Listener>> open(std::string_view scheme, std::string_view host_scheme,
                                                     const std::string& endpoint);
  ~Listener();
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  /// For poll().
  int descriptor() const noexcept { return descriptor_; }
  /// A host that has connected, as a socket that does not block and does not delay; the caller closes it. -1: none has.
  int accept() const;
  /// What a host writes to connect: "tcp:127.0.0.1:33333".
  const std::string& path() const noexcept { return path_; }
  /// LINK text that opens the same port again, also where any was asked for.
  const std::string& link() const noexcept { return link_; }

 private:
  Listener(int descriptor, std::string path, std::string link)
      : descriptor_(descriptor), path_(std::move(path)), link_(std::move(link)) {}

  int descriptor_;
  std::string path_, link_;
};

}  // namespace tandem::bridges
