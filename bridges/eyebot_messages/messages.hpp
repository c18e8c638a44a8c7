// The messages of eyebot.lcm under our own names. Units and frames stand in that file, beside each member.
#pragma once
#include <eyebot/ack_t.hpp>
#include <eyebot/altitude_t.hpp>
#include <eyebot/battery_t.hpp>
#include <eyebot/blobs_t.hpp>
#include <eyebot/cmd_mode_t.hpp>
#include <eyebot/cmd_pan_tilt_t.hpp>
#include <eyebot/cmd_position_t.hpp>
#include <eyebot/cmd_rab_t.hpp>
#include <eyebot/cmd_scanner_t.hpp>
#include <eyebot/cmd_velocity_t.hpp>
#include <eyebot/heartbeat_t.hpp>
#include <eyebot/image_t.hpp>
#include <eyebot/leds_t.hpp>
#include <eyebot/light_t.hpp>
#include <eyebot/pan_tilt_t.hpp>
#include <eyebot/prox_t.hpp>
#include <eyebot/rab_t.hpp>
#include <eyebot/scan_t.hpp>
#include <eyebot/state_t.hpp>
#include <eyebot/status_t.hpp>

namespace tandem::bridges::eyebot_messages {

using Header = ::eyebot::header_t;

// Both ways.
using Heartbeat = ::eyebot::heartbeat_t;
using Leds = ::eyebot::leds_t;

// From the robot.
using Status = ::eyebot::status_t;
using State = ::eyebot::state_t;
using Altitude = ::eyebot::altitude_t;
using Battery = ::eyebot::battery_t;
using Scan = ::eyebot::scan_t;
using Rab = ::eyebot::rab_t;
using RabPacket = ::eyebot::rab_packet_t;
using Prox = ::eyebot::prox_t;
using Light = ::eyebot::light_t;
using PanTilt = ::eyebot::pan_tilt_t;
using Blob = ::eyebot::blob_t;
using Blobs = ::eyebot::blobs_t;
using Image = ::eyebot::image_t;
using Ack = ::eyebot::ack_t;

// To the robot.
using CmdMode = ::eyebot::cmd_mode_t;
using CmdPosition = ::eyebot::cmd_position_t;
using CmdVelocity = ::eyebot::cmd_velocity_t;
using CmdPanTilt = ::eyebot::cmd_pan_tilt_t;
using CmdScanner = ::eyebot::cmd_scanner_t;
using CmdRab = ::eyebot::cmd_rab_t;

}  // namespace tandem::bridges::eyebot_messages
