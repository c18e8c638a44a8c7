// Opens a page in the browser of this machine's user.
#pragma once
#include <string>

namespace tandem::app {

/// Does not wait for it. @returns whether there is a desktop and a program (xdg-open) to ask for it
bool open_browser(const std::string& address);

}  // namespace tandem::app
