// The names that scenes, tables and messages use for the closed sets of problem.hpp.
#include "sim/problem.hpp"

namespace beamcam::sim {

const char* name(ModelKind kind) {
    switch (kind) {
        case ModelKind::rigid:
            return "rigid";
        case ModelKind::zeroth_order:
            return "zeroth-order";
        case ModelKind::first_order:
            return "first-order";
        case ModelKind::paper:
            return "paper";
        case ModelKind::second_order:
            return "second-order";
        case ModelKind::exact:
            return "exact";
    }
    return "?";
}

const char* name(Basis basis) {
    switch (basis) {
        case Basis::automatic:
            return "auto";
        case Basis::cantilever:
            return "cantilever";
        case Basis::hub_beam:
            return "hub-beam";
    }
    return "?";
}

const char* name(DampingLaw law) {
    switch (law) {
        case DampingLaw::none:
            return "none";
        case DampingLaw::hunt_crossley:
            return "hunt-crossley";
        case DampingLaw::lankarani_nikravesh:
            return "lankarani-nikravesh";
        case DampingLaw::herbert_mcwhannell:
            return "herbert-mcwhannell";
        case DampingLaw::lee_wang:
            return "lee-wang";
        case DampingLaw::gonthier:
            return "gonthier";
        case DampingLaw::flores:
            return "flores";
        case DampingLaw::hu_guo:
            return "hu-guo";
        case DampingLaw::zhang_sharf:
            return "zhang-sharf";
    }
    return "?";
}

const char* name(ImpactLaw law) {
    switch (law) {
        case ImpactLaw::newton:
            return "newton";
        case ImpactLaw::poisson:
            return "poisson";
        case ImpactLaw::stronge:
            return "stronge";
    }
    return "?";
}

const char* name(ContactModel model) {
    switch (model) {
        case ContactModel::compliant:
            return "compliant";
        case ContactModel::restitution:
            return "restitution";
    }
    return "?";
}

const char* name(InitialShape shape) {
    switch (shape) {
        case InitialShape::straight:
            return "straight";
        case InitialShape::static_equilibrium:
            return "static";
        case InitialShape::resting:
            return "resting";
    }
    return "?";
}

const char* name(Method method) {
    switch (method) {
        case Method::automatic:
            return "auto";
        case Method::exponential:
            return "exponential";
        case Method::rk8:
            return "rk8";
        case Method::cvode_adams:
            return "cvode-adams";
        case Method::cvode_bdf:
            return "cvode-bdf";
        case Method::arkode_erk:
            return "arkode-erk";
    }
    return "?";
}

}  // namespace beamcam::sim
