// Reads the file that says which variable of which node is which field of which port of a foot-bot.
//
//   <footbot_map profile="…" refresh="500 ms">
//     <node names="left motor|wheel-left" needed="always">          the first name that answers counts
//       <variable names="speed" words="1" verify="true">            so does the first that the node has
//         <write port="differential_steering" field="left" scale="0.41398 cm/s" least="-72" most="72"/>
//       </variable>
//       <variable names="odo" words="2">
//         <read port="wheel_encoders" field="left" form="int32" scale="…" accumulate="true" rate="left_speed"/>
//       </variable>
//     </node>
//     …
// configs/footbot_map.xml explains each attribute.
#pragma once
#include <optional>
#include <string>

#include "bridges/footbot/map.hpp"
#include "hal/element.hpp"
#include "hal/result.hpp"

namespace tandem::bridges::footbot {

/// Every problem is appended, with file and line; nothing is returned when one of them is an error.
std::optional<FootbotMap> read_footbot_map(const std::string& path, hal::Problems& problems);

/// The map of a robot. Error: all that is wrong with it, for people.
hal::Result<FootbotMap> footbot_map_for(const std::string& robot, const std::string& path);

/// As `read_footbot_map`, from text; `name` stands for the file in messages.
std::optional<FootbotMap> read_footbot_map_text(const std::string& text, const std::string& name,
                                                hal::Problems& problems);

}  // namespace tandem::bridges::footbot
