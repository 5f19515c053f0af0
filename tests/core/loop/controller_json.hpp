#pragma once

#include <limits>

#include <nlohmann/json.hpp>

#include "core/loop/parameters.hpp"

namespace zerocount::testing {

/// JSON of a limit; null if the limit is off.
inline nlohmann::ordered_json limit_json(double value) {
  if (value < 0.0 || value == std::numeric_limits<double>::infinity()) return nullptr;
  return value;
}

inline nlohmann::ordered_json filter_json(const loop::Filter& f) {
  switch (f.kind) {
    case loop::FilterKind::lowpass:
      return {{"lowpass", {{"frequency", f.frequency}, {"damping", f.damping}}}};
    case loop::FilterKind::notch:
      return {{"notch", {{"frequency", f.frequency}, {"damping", f.damping}, {"depth", f.depth}}}};
    case loop::FilterKind::lead:
      return {{"lead", {{"frequency", f.frequency}, {"ratio", f.ratio}}}};
    case loop::FilterKind::biquad:
      break;
  }
  return {{"biquad", {{"b", f.b}, {"a", f.a}}}};
}

inline void add_blocks(nlohmann::ordered_json& to, const loop::ControlBlocks& b) {
  to["structure"] = b.structure == loop::ControlStructure::cascade ? "cascade" : "pid";
  const loop::CascadeParameters& c = b.cascade;
  to["cascade"] = {{"kv", c.kv},
                   {"kp", c.kp},
                   {"ki", c.ki},
                   {"feedforward", c.feedforward},
                   {"divider", c.divider},
                   {"latency", c.latency},
                   {"resolution", c.resolution},
                   {"limit", limit_json(c.limit)}};
  to["derivative_window"] = b.derivative_window;
  to["deadband"] = {{"enter", limit_json(b.deadband.enter)}, {"leave", limit_json(b.deadband.leave)}};
  to["integrator_zone"] = limit_json(b.integrator_zone);
  to["integrator_leak"] = limit_json(b.integrator_leak);
  to["derivative_cutoff"] = limit_json(b.derivative_cutoff);
  to["filters"] = nlohmann::ordered_json::array();
  for (const loop::Filter& f : b.filters) to["filters"].push_back(filter_json(f));
  to["feedforward"] = {{"velocity", b.feedforward.velocity},
                       {"acceleration", b.feedforward.acceleration},
                       {"friction", b.feedforward.friction}};
  to["observer"] = {{"bandwidth", b.observer.bandwidth}, {"inertia", b.observer.inertia}};
  to["error_deadband"] = {{"band", limit_json(b.error_deadband.band)},
                          {"form", b.error_deadband.form == loop::DeadbandForm::zero ? "zero" : "subtract"}};
  to["hold"] = {
      {"enter", limit_json(b.hold.enter)}, {"leave", limit_json(b.hold.leave)}, {"dwell", b.hold.dwell}};
  to["standstill"] = {{"band", limit_json(b.standstill.band)},
                      {"dwell", b.standstill.dwell},
                      {"kp", b.standstill.kp},
                      {"ki", b.standstill.ki},
                      {"kd", b.standstill.kd}};
}

/// JSON of the controller, in the form of a manifest.
inline nlohmann::ordered_json controller_json(const loop::ControllerParameters& c) {
  const auto encoder = [](loop::EncoderChoice choice) {
    return choice == loop::EncoderChoice::fine ? "fine" : "coarse";
  };
  nlohmann::ordered_json controller{
      {"sample_rate", c.sample_rate},
      {"kp", c.kp},
      {"ki", c.ki},
      {"kd", c.kd},
      {"anti_windup", c.anti_windup == loop::AntiWindup::clamp ? "clamp" : "none"},
      {"encoder", encoder(c.encoder)}};
  add_blocks(controller, c.blocks);
  nlohmann::ordered_json coarse{{"kp", c.coarse.kp},
                                {"ki", c.coarse.ki},
                                {"kd", c.coarse.kd},
                                {"encoder", encoder(c.coarse.encoder)},
                                {"fine_within", c.coarse.fine_within},
                                {"fine_rate", c.coarse.fine_rate},
                                {"fine_dwell", c.coarse.fine_dwell},
                                {"coarse_beyond", limit_json(c.coarse.coarse_beyond)}};
  add_blocks(coarse, c.coarse.blocks);
  controller["coarse"] = coarse;
  return controller;
}

}  // namespace zerocount::testing
