// Keys for commands over LCM: where a run and `tandem desk` find them.
//
//   --keys FILE                             if it is given; else
//   $XDG_CONFIG_HOME/tandem/desk.keys       if it is there (~/.config without that variable); else
//   a key of this user on this machine      made by the run, in the folder of locks: unreadable to others
#pragma once
#include <string>
#include <vector>

#include "bridges/desk/keys.hpp"
#include "hal/result.hpp"

namespace tandem::app {

/// Of a run that listens on this address. Errors: a file of keys that cannot be used; no folder for an own key.
hal::Result<std::vector<bridges::desk::DeskKey>> keys_to_listen(const std::string& file, const std::string& url,
                                                                const std::string& channel);

/// The key by which `who` commands the run that listens there. Errors: as above; there is none.
hal::Result<bridges::desk::DeskKey> key_to_ask(const std::string& file, const std::string& url,
                                               const std::string& channel, const std::string& who);

}  // namespace tandem::app
