#include "tests/support/trial_json.hpp"

#include <array>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <nlohmann/json.hpp>

#include "core/trial/random_history.hpp"

namespace zerocount::testing {

namespace {

using nlohmann::json;

constexpr std::array<std::pair<const char*, double friction::FrictionParameters::*>, 9> friction_names{{
    {"k1", &friction::FrictionParameters::k1},
    {"k2", &friction::FrictionParameters::k2},
    {"beta", &friction::FrictionParameters::beta},
    {"alpha", &friction::FrictionParameters::alpha},
    {"lambda", &friction::FrictionParameters::lambda},
    {"n", &friction::FrictionParameters::n},
    {"breakaway", &friction::FrictionParameters::breakaway},
    {"coulomb_ratio", &friction::FrictionParameters::coulomb_ratio},
    {"stribeck_velocity", &friction::FrictionParameters::stribeck_velocity},
}};

constexpr std::array<std::pair<const char*, friction::FrictionModel>, 4> model_names{
    {{"presliding", friction::FrictionModel::presliding},
     {"spring", friction::FrictionModel::spring},
     {"coulomb", friction::FrictionModel::coulomb},
     {"none", friction::FrictionModel::none}}};

json friction_json(const friction::FrictionAlongRotor& friction) {
  json out;
  for (const auto& [name, member] : friction_names) out[name] = friction.uniform.*member;
  for (const auto& [name, model] : model_names) {
    if (model == friction.model) out["model"] = name;
  }
  out["profiled"] = json::array();
  for (const friction::ProfiledParameter& entry : friction.profiled) {
    for (const auto& [name, member] : friction_names) {
      if (member != entry.parameter) continue;
      const friction::Profile& p = *entry.profile;
      out["profiled"].push_back(
          {{"parameter", name},
           {"marginal", p.marginal == friction::Marginal::lognormal ? "lognormal" : "normal"},
           {"location", p.location},
           {"scale", p.scale},
           {"cosine", p.cosine},
           {"sine", p.sine}});
    }
  }
  return out;
}

friction::FrictionAlongRotor friction_from(const json& in) {
  friction::FrictionAlongRotor friction;
  for (const auto& [name, member] : friction_names) friction.uniform.*member = in.at(name);
  for (const auto& [name, model] : model_names) {
    if (in.at("model") == name) friction.model = model;
  }
  for (const json& entry : in.value("profiled", json::array())) {
    friction::Profile p;
    p.marginal =
        entry.at("marginal") == "lognormal" ? friction::Marginal::lognormal : friction::Marginal::normal;
    p.location = entry.at("location");
    p.scale = entry.at("scale");
    p.cosine = entry.at("cosine").get<std::vector<double>>();
    p.sine = entry.at("sine").get<std::vector<double>>();
    for (const auto& [name, member] : friction_names) {
      if (entry.at("parameter") == name)
        friction.profiled.push_back({member, std::make_shared<const friction::Profile>(p)});
    }
  }
  return friction;
}

}  // namespace

std::string to_json(const trial::TrialParameters& p) {
  const loop::ControllerParameters& c = p.controller;
  const json out = {
      {"plant",
       {{"inertia", p.plant.inertia},
        {"presliding_damping", p.plant.presliding_damping},
        {"sliding_damping", p.plant.sliding_damping}}},
      {"friction", friction_json(p.friction)},
      {"encoder", {{"fine", p.encoder.fine}, {"coarse", p.encoder.coarse}}},
      {"dac", {{"bits", p.dac.bits}, {"resolution", p.dac.resolution}}},
      {"amplifier", {{"bandwidth", p.amplifier.bandwidth}}},
      {"controller",
       {{"sample_rate", c.sample_rate},
        {"kp", c.kp},
        {"ki", c.ki},
        {"kd", c.kd},
        {"delay", c.delay},
        {"anti_windup", c.anti_windup == loop::AntiWindup::clamp ? "clamp" : "none"}}},
      {"command", {{"targets", p.command.targets}, {"hold", p.command.hold}}},
      {"initial",
       {{"encoder_phase", p.initial.encoder_phase},
        {"position", p.initial.position},
        {"hardening", p.initial.hardening},
        {"preload", p.initial.preload},
        {"history", {{"reversals", p.initial.history.reversals}, {"torque", p.initial.history.torque}}},
        {"history_levels", trial::draw_history(p.initial.history, p.randomness)},
        {"velocity", p.initial.velocity},
        {"integral", p.initial.integral},
        {"mode", p.initial.mode == trial::InitialMode::slide ? "slide" : "stick"}}},
      {"randomness",
       {{"trial", p.randomness.trial}, {"stream", p.randomness.stream}, {"history", p.randomness.history}}},
      {"verdict", {{"dwell", p.verdict.dwell}, {"window", p.verdict.window}}},
  };
  return out.dump(1);
}

trial::TrialParameters trial_from_json(std::istream& in) {
  const json j = json::parse(in);
  trial::TrialParameters p;
  p.plant = {j["plant"].at("inertia"), j["plant"].at("presliding_damping"), j["plant"].at("sliding_damping")};
  p.friction = friction_from(j.at("friction"));
  p.encoder = {j["encoder"].at("fine"), j["encoder"].at("coarse")};
  p.dac = {j["dac"].at("bits"), j["dac"].at("resolution")};
  const json& c = j.at("controller");
  p.controller = {
      c.at("sample_rate"), c.at("kp"),
      c.at("ki"),          c.at("kd"),
      c.at("delay"),       c.at("anti_windup") == "none" ? loop::AntiWindup::none : loop::AntiWindup::clamp};
  p.command.targets = j["command"].at("targets").get<std::vector<std::int64_t>>();
  p.command.hold = j["command"].at("hold");
  const json& i = j.at("initial");
  p.initial = {i.at("encoder_phase"), i.at("position"), i.at("hardening"), i.at("preload")};
  p.initial.history = {i["history"].at("reversals"), i["history"].at("torque")};
  p.initial.velocity = i.at("velocity");
  p.initial.integral = i.at("integral");
  p.initial.mode = i.at("mode") == "slide" ? trial::InitialMode::slide : trial::InitialMode::stick;
  p.amplifier.bandwidth = j["amplifier"].at("bandwidth");
  const json& r = j.at("randomness");
  p.randomness.trial = r.at("trial");
  p.randomness.stream = r.at("stream");
  p.randomness.history = r.at("history").get<random::RandomKey>();
  p.verdict = {j["verdict"].at("dwell"), j["verdict"].at("window")};
  return p;
}

std::vector<trial::SampleRecord> read_trace_csv(std::istream& in) {
  std::string line;
  std::getline(in, line);
  if (line != "k,t,target,count,coarse_count,error,code,torque,theta,omega,xp,xh,depth,mode") {
    throw std::runtime_error("trace: unexpected header: " + line);
  }
  std::vector<trial::SampleRecord> records;
  while (std::getline(in, line)) {
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    if (cells.size() != 14) throw std::runtime_error("trace: unexpected row: " + line);
    const auto integer = [&](std::size_t i) { return std::int64_t{std::stoll(cells[i])}; };
    const auto number = [&](std::size_t i) { return std::strtod(cells[i].c_str(), nullptr); };
    records.push_back({integer(0), number(1), integer(2), integer(3), integer(4), integer(5), integer(6),
                       number(7), number(8), number(9), number(10), number(11), integer(12),
                       cells[13] == "slide" ? trial::HookMode::slide : trial::HookMode::stick});
    records.back().drive_torque = std::numeric_limits<double>::quiet_NaN();
  }
  return records;
}

}  // namespace zerocount::testing
