// Doorway: admission of viewers. Pure functions over a request.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace tandem::window {

/// The value of a name in the query of a request's target, decoded; empty: it is not there, or no text.
std::string query_value(std::string_view target, std::string_view name);

/// The path of a request's target: what stands before "?".
std::string_view path_of(std::string_view target) noexcept;

/// Which names this server answers to. A page of a stranger whose name leads to this machine (DNS rebinding) sends its
/// own name as Host; a page of another server sends its own address as Origin.
struct Doorway {
  std::string machine;               ///< the name of this machine; empty: that is not answered to
  std::vector<std::string> origins;  ///< further ones, "http://host:port"

  /// Numbers, "localhost" and this machine's name with any port (it may be forwarded), and the hosts of `origins`.
  bool host_is_ours(std::string_view host) const;
  /// `origin` absent (empty): no browser. Else it must be that of `host`, or one of `origins`.
  bool origin_is_ours(std::string_view origin, std::string_view host) const;
};

}  // namespace tandem::window
