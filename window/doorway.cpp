#include "window/doorway.hpp"

#include <algorithm>
#include <cctype>

namespace tandem::window {
namespace {

bool same_name(std::string_view a, std::string_view b) noexcept {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

/// Without ":port"; of "[::1]:80" what stands between the brackets. Empty: it is none.
std::string_view name_of(std::string_view host) noexcept {
  if (host.starts_with('[')) {
    const std::size_t end = host.find(']');
    if (end == std::string_view::npos || (end + 1 < host.size() && host[end + 1] != ':')) return {};
    return host.substr(1, end - 1);
  }
  const std::size_t colon = host.find(':');
  if (colon == std::string_view::npos) return host;
  return host.find(':', colon + 1) == std::string_view::npos ? host.substr(0, colon) : std::string_view{};
}

/// Whether these are numbers of an IPv4 or IPv6 address, which no name server has a say in.
bool is_numbers(std::string_view name) noexcept {
  const bool v6 = name.find(':') != std::string_view::npos;
  if (name.empty() || (!v6 && std::isdigit(static_cast<unsigned char>(name.back())) == 0)) return false;
  return std::all_of(name.begin(), name.end(), [v6](unsigned char c) {
    return v6 ? std::isxdigit(c) != 0 || c == ':' || c == '.' : std::isdigit(c) != 0 || c == '.';
  });
}

int digit_of(char c) noexcept {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

}  // namespace

std::string_view path_of(std::string_view target) noexcept {
  return target.substr(0, target.find_first_of("?#"));
}

std::string query_value(std::string_view target, std::string_view name) {
  const std::size_t mark = target.find('?');
  std::string_view rest = mark == std::string_view::npos ? std::string_view{} : target.substr(mark + 1);
  rest = rest.substr(0, rest.find('#'));
  while (!rest.empty()) {
    const std::string_view pair = rest.substr(0, rest.find('&'));
    rest.remove_prefix(std::min(rest.size(), pair.size() + 1));
    const std::size_t equals = pair.find('=');
    if (equals == std::string_view::npos || pair.substr(0, equals) != name) continue;
    const std::string_view raw = pair.substr(equals + 1);
    std::string value;
    for (std::size_t i = 0; i < raw.size(); ++i) {
      if (raw[i] != '%') {
        value += raw[i] == '+' ? ' ' : raw[i];
        continue;
      }
      const int high = i + 2 < raw.size() ? digit_of(raw[i + 1]) : -1;
      const int low = high >= 0 ? digit_of(raw[i + 2]) : -1;
      if (low < 0) return {};
      value += static_cast<char>(16 * high + low);
      i += 2;
    }
    return value;
  }
  return {};
}

bool Doorway::host_is_ours(std::string_view host) const {
  const std::string_view name = name_of(host);
  if (name.empty()) return false;
  if (is_numbers(name) || same_name(name, "localhost") || (!machine.empty() && same_name(name, machine))) return true;
  return std::any_of(origins.begin(), origins.end(), [&](const std::string& origin) {
    const std::size_t slashes = origin.find("://");
    return slashes != std::string::npos && same_name(std::string_view(origin).substr(slashes + 3), host);
  });
}

bool Doorway::origin_is_ours(std::string_view origin, std::string_view host) const {
  if (origin.empty()) return true;
  const auto is = [&](std::string_view other) { return same_name(origin, other); };
  return is("http://" + std::string(host)) || std::any_of(origins.begin(), origins.end(), is);
}

}  // namespace tandem::window
