// The names of the enumerations of problem.hpp in scenes, tables and messages. Those of the dissipation laws are beside
// their formulas in contact/dissipation.cpp.
#include "sim/problem/keys.hpp"

namespace beamcam::sim {
namespace {

constexpr Named<ModelKind> kModels[] = {
    {ModelKind::rigid, "rigid"}, {ModelKind::zeroth_order, "zeroth-order"}, {ModelKind::first_order, "first-order"},
    {ModelKind::paper, "paper"}, {ModelKind::second_order, "second-order"}, {ModelKind::exact, "exact"}};
constexpr Named<Basis> kBases[] = {
    {Basis::automatic, "auto"}, {Basis::cantilever, "cantilever"}, {Basis::hub_beam, "hub-beam"}};
constexpr Named<ImpactLaw> kImpactLaws[] = {
    {ImpactLaw::newton, "newton"}, {ImpactLaw::poisson, "poisson"}, {ImpactLaw::stronge, "stronge"}};
constexpr Named<ContactModel> kContactModels[] = {{ContactModel::compliant, "compliant"},
                                                  {ContactModel::restitution, "restitution"}};
constexpr Named<ApproachFloorPolicy> kPolicies[] = {{ApproachFloorPolicy::value, "value"},
                                                    {ApproachFloorPolicy::first_touch, "first-touch"}};
constexpr Named<InitialShape> kInitialShapes[] = {{InitialShape::straight, "straight"},
                                                  {InitialShape::static_equilibrium, "static"},
                                                  {InitialShape::resting, "resting"}};
constexpr Named<Method> kMethods[] = {
    {Method::automatic, "auto"},          {Method::exponential, "exponential"}, {Method::rk8, "rk8"},
    {Method::cvode_adams, "cvode-adams"}, {Method::cvode_bdf, "cvode-bdf"},     {Method::arkode_erk, "arkode-erk"}};

template <class Enum>
const char* name_of(Enum value) {
    for (const Named<Enum>& each : names(value))
        if (each.value == value) return each.name;
    return "?";
}

}  // namespace

std::span<const Named<ModelKind>> names(ModelKind) { return kModels; }
std::span<const Named<Basis>> names(Basis) { return kBases; }
std::span<const Named<ImpactLaw>> names(ImpactLaw) { return kImpactLaws; }
std::span<const Named<ContactModel>> names(ContactModel) { return kContactModels; }
std::span<const Named<ApproachFloorPolicy>> names(ApproachFloorPolicy) { return kPolicies; }
std::span<const Named<InitialShape>> names(InitialShape) { return kInitialShapes; }
std::span<const Named<Method>> names(Method) { return kMethods; }

const char* name(ModelKind value) { return name_of(value); }
const char* name(Basis value) { return name_of(value); }
const char* name(DampingLaw value) { return name_of(value); }
const char* name(ImpactLaw value) { return name_of(value); }
const char* name(ContactModel value) { return name_of(value); }
const char* name(InitialShape value) { return name_of(value); }
const char* name(Method value) { return name_of(value); }

}  // namespace beamcam::sim
