#include "experiments/parameters/handles.hpp"
#include "experiments/parameters/parameter_rows.hpp"

namespace zerocount::parameters {
namespace {

constexpr std::size_t max_gms_elements = 16;
constexpr std::string_view instead_of_spring = "in place of k1, k2, beta and breakaway";
constexpr std::string_view instead_of_creep = "in place of alpha, lambda and n";

template <double friction::FrictionParameters::*field>
Parameter friction(Parameter row) {
  row.profiled = field;
  return stored_at(std::move(row), [](auto& p) { return &(p.friction.uniform.*field); });
}

template <double friction::FrictionParameters::*field>
Parameter on_load(Parameter row) {
  return stored_at(std::move(row), [](auto& p) { return &(p.load_side.friction.contact.*field); });
}

}  // namespace

std::vector<Parameter> plant_rows() {
  using P = friction::FrictionParameters;
  return {
      real_row(parameter::plant::inertia, 12, "kg m^2", "$inertia J of the $rotor", "paper, section 4",
               numerics::above(0), [](auto& p) { return &p.plant.inertia; }),
      real_row(parameter::plant::presliding_damping, 13, "N m s/rad",
               "damping c while the hook sticks, or of an air bearing", "paper, section 4",
               numerics::at_least(0), [](auto& p) { return &p.plant.presliding_damping; }),
      real_row(parameter::plant::sliding_damping, 14, "N m s/rad", "viscous damping cs while the hook slides",
               assumed, numerics::at_least(0), [](auto& p) { return &p.plant.sliding_damping; }),
      idealised_by(rigid_axis,
                   real_row(parameter::plant::load::inertia, beyond_moves(12), "kg m^2",
                            "inertia JL of a second mass behind an elastic coupling; 0: no second mass",
                            assumed, numerics::at_least(0), [](auto& p) { return &p.plant.load.inertia; })),
      idealised_by(stiffer_coupling, real_row(parameter::plant::load::stiffness, beyond_moves(13), "N m/rad",
                                              "stiffness kL of the coupling", assumed, numerics::above(0),
                                              [](auto& p) { return &p.plant.load.stiffness; })),
      real_row(parameter::plant::load::damping, beyond_moves(14), "N m s/rad", "damping dL of the coupling",
               assumed, numerics::at_least(0), [](auto& p) { return &p.plant.load.damping; }),
      word_row(parameter::plant::load::encoder, beyond_moves(15),
               "the mass whose $angle closes the loop; without a second encoder, both read it", assumed,
               {"motor", "load"}, [](auto& p) { return &p.plant.load.encoder; }),
      ideal_at(0, "no gap in the coupling",
               real_row(parameter::plant::load::gap, beyond_moves(285), "rad",
                        "gap of the coupling (backlash), its whole play", assumed, numerics::at_least(0),
                        [](auto& p) { return &p.plant.load.gap; })),
      real_row(parameter::plant::load::damping_to_ground, beyond_moves(286), "N m s/rad",
               "viscous damping of the second mass against the frame", assumed, numerics::at_least(0),
               [](auto& p) { return &p.plant.load.damping_to_ground; }),
      idealised_by(no_load_friction, word_row(parameter::plant::load::friction::model, beyond_moves(289),
                                              "friction law of the second mass, without its viscous part",
                                              assumed, {"none", "coulomb", "dahl", "lugre"},
                                              [](auto& p) { return &p.load_side.friction.model; })),
      on_load<&P::breakaway>(real_row(parameter::plant::load::friction::breakaway, beyond_moves(290), "N m",
                                      "$torque at which the second mass starts to slide", assumed,
                                      numerics::above(0))),
      on_load<&P::coulomb_ratio>(
          ideal_at(1, "no fall of the load's friction from breakaway",
                   real_row(parameter::plant::load::friction::coulomb_ratio, beyond_moves(291), "1",
                            "ratio of its Coulomb level to breakaway", assumed,
                            {.low = 0, .high = 1, .high_included = true}))),
      on_load<&P::stribeck_velocity>(
          real_row(parameter::plant::load::friction::stribeck_velocity, beyond_moves(292), "rad/s",
                   "velocity over which its sliding friction falls to the Coulomb level", assumed,
                   numerics::above(0))),
      on_load<&P::sigma0>(real_row(parameter::plant::load::friction::sigma0, beyond_moves(293), "N m/rad",
                                   "stiffness of its bristles (dahl, lugre)", assumed, numerics::above(0))),
      on_load<&P::sigma1>(real_row(parameter::plant::load::friction::sigma1, beyond_moves(294), "N m s/rad",
                                   "damping of its bristles (lugre)", assumed, numerics::at_least(0))),
  };
}

std::vector<Parameter> friction_rows() {
  using P = friction::FrictionParameters;
  return {
      word_row(
          parameter::friction::model, beyond_moves(0),
          "friction law of the bearing. "
          "Pre-sliding motion: a spring with creep (presliding), the spring alone (spring) or none (coulomb). "
          "Others: no friction (none, an air bearing), Dahl, LuGre, generalised Maxwell-slip (gms)",
          assumed, friction::friction_model_labels(), [](auto& p) { return &p.friction.model; }),
      friction<&P::k1>(real_row(parameter::friction::k1, 0, "N m/rad",
                                "lowest tangent stiffness of the friction spring", "paper, section 4",
                                numerics::above(0))),
      friction<&P::k2>(real_row(parameter::friction::k2, 1, "N m/rad",
                                "highest tangent stiffness of the friction spring minus k1",
                                "paper, section 4 (k1 + k2 = 860)", numerics::at_least(0))),
      friction<&P::beta>(
          real_row(parameter::friction::beta, 3, "1/rad", "rate at which a branch softens from k1 + k2 to k1",
                   "assumed (from the outcomes in section 4 of the paper)", numerics::above(0))),
      friction<&P::alpha>(
          ideal_at(0, "creep off",
                   real_row(parameter::friction::alpha, 4, "1/s", "rate of creep; 0 switches creep off",
                            assumed, numerics::at_least(0)))),
      friction<&P::lambda>(real_row(parameter::friction::lambda, 5, "(N m)^n/rad",
                                    "hardening modulus: creep ends at |$torque|^n / lambda", assumed,
                                    numerics::above(0))),
      friction<&P::n>(real_row(parameter::friction::n, 15, "1", "exponent of the $torque in the creep law",
                               assumed, numerics::at_least(1))),
      friction<&P::breakaway>(real_row(parameter::friction::breakaway, 6, "N m",
                                       "$torque at which the hook starts to slide", assumed,
                                       numerics::above(0))),
      friction<&P::coulomb_ratio>(ideal_at(
          1, "no fall of friction from breakaway",
          real_row(parameter::friction::coulomb_ratio, 7, "1", "ratio of the Coulomb level to breakaway",
                   assumed, {.low = 0, .high = 1, .high_included = true}))),
      friction<&P::stribeck_velocity>(real_row(
          parameter::friction::stribeck_velocity, 8, "rad/s",
          "velocity over which sliding friction falls to the Coulomb level", assumed, numerics::above(0))),
      friction<&P::sigma0>(real_row(parameter::friction::sigma0, beyond_moves(9), "N m/rad",
                                    "stiffness of the bristles of dahl and lugre",
                                    "assumed (k1 + k2 of the paper)", numerics::above(0))),
      friction<&P::sigma1>(real_row(parameter::friction::sigma1, beyond_moves(10), "N m s/rad",
                                    "damping of the bristles of lugre", "assumed (the paper's c)",
                                    numerics::at_least(0))),
      friction<&P::gms_attraction>(
          real_row(parameter::friction::gms::attraction, beyond_moves(11), "N m/s",
                   "rate at which the $torque of a slipping element of gms approaches its level", assumed,
                   numerics::above(0))),
      list_of(
          max_gms_elements, "stiffness", "stiffnesses",
          real_row(
              parameter::friction::gms::stiffness, beyond_moves(80), "N m/rad",
              "stiffness kappa of each element of the generalised Maxwell-slip model; default on a rotary axis: 110, 250, 250, 250",
              "required", numerics::above(0)),
          [](auto& p, std::size_t i) { return &p.friction.gms_elements[i].stiffness; }),
      list_of(
          max_gms_elements, "weight", "weights",
          real_row(parameter::friction::gms::weight, beyond_moves(80 + max_gms_elements), "1",
                   "weight eta of each element: its fraction of the friction level, all of which sum to 1; "
                   "default on a rotary axis: 0.9875, 0.0009, 0.0032, 0.0084",
                   "required", {.low = 0, .high = 1, .high_included = true}),
          [](auto& p, std::size_t i) { return &p.friction.gms_elements[i].weight; }),
      real_row(parameter::friction::measured::initial_stiffness, beyond_moves(272), "N m/rad",
               "stiffness k1 + k2 with which the friction spring begins", instead_of_spring,
               numerics::above(0)),
      real_row(parameter::friction::measured::secant_stiffness, beyond_moves(273), "N m/rad",
               "$torque over travel of the virgin curve at secant_travel; in place of initial_stiffness",
               instead_of_spring, numerics::above(0)),
      real_row(parameter::friction::measured::secant_travel, beyond_moves(274), "rad",
               "travel over which secant_stiffness was measured", instead_of_spring, numerics::above(0)),
      real_row(parameter::friction::measured::final_stiffness, beyond_moves(275), "N m/rad",
               "stiffness k1 to which the friction spring softens", instead_of_spring, numerics::above(0)),
      real_row(parameter::friction::measured::breakaway, beyond_moves(276), "N m",
               "$torque at which the hook starts to slide", instead_of_spring, numerics::above(0)),
      real_row(parameter::friction::measured::breakaway_travel, beyond_moves(277), "rad",
               "travel of the virgin curve up to breakaway, the pre-sliding range", instead_of_spring,
               numerics::above(0)),
      real_row(parameter::friction::measured::creep::torque, beyond_moves(268), "N m",
               "$torque under which creep was measured; with extension in place of friction.lambda",
               instead_of_creep, numerics::above(0)),
      real_row(parameter::friction::measured::creep::extension, beyond_moves(269), "rad",
               "extension at which creep under that $torque ends: lambda = $torque^exponent / extension",
               instead_of_creep, numerics::above(0)),
      real_row(parameter::friction::measured::creep::rate, beyond_moves(270), "1/s",
               "rate of creep, in place of friction.alpha; 0 switches creep off", instead_of_creep,
               numerics::at_least(0)),
      real_row(parameter::friction::measured::creep::exponent, beyond_moves(271), "1",
               "exponent of the $torque in the creep law, in place of friction.n", instead_of_creep,
               numerics::at_least(1)),
  };
}

}  // namespace zerocount::parameters
