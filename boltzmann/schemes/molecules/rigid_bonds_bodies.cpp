// Molecules whose rigid bonds make them bodies.
#include <boltzmann/schemes/molecules/rigid_bonds.hpp>

#include <array>
#include <cmath>

namespace boltzmann {
namespace {

/// Temporary numbers of one molecule, without allocation for few particles.
template <class T>
class Scratch {
 public:
  explicit Scratch(std::size_t size) : size_(size) {
    if (size > few.size()) many.resize(size);
  }
  std::span<T> all() { return {size_ > few.size() ? many.data() : few.data(), size_}; }

 private:
  std::size_t size_;
  std::array<T, 16> few;
  std::vector<T> many;
};

}  // namespace

/// The motion of a body: of its centre, and about it.
struct RigidBonds::BodyMotion {
  double mass = 0;
  Vector<3> velocity{0, 0, 0}, rotation{0, 0, 0};
  SymmetricMatrix inertia{};
};

/// The current arms of a body: its exact shape in the orientation of its particles.
void RigidBonds::arms_of(Molecule const& body, std::span<Vector<3>> arms) const {
  Scratch<Vector<3>> places(body.size);
  Scratch<double> masses(body.size);
  for (std::size_t k = 0; k < body.size; ++k) {
    std::uint32_t const i = member_[body.members + k], anchor = anchor_[body.members + k];
    places.all()[k] = k == 0 ? Vector<3>{0, 0, 0} : places.all()[anchor] + between(member_[body.members + anchor], i);
    masses.all()[k] = ensemble_.row(i)[mass_];
  }
  turn_as(shapes_[body.shape], places.all(), masses.all(), box_.dimension(), arms);
}

bool RigidBonds::correct_body(Molecule const& body, double dt) {
  auto const D = static_cast<std::size_t>(box_.dimension());
  double const per_time = dt != 0 ? 1 / dt : 0;
  auto const arms = noted_arms(body);
  Scratch<Vector<3>> moved(body.size);  // displacements in the body, relative to that of the first particle
  Scratch<double> masses(body.size);
  Vector<3> centre{0, 0, 0}, torque{0, 0, 0};
  double mass = 0;
  std::uint32_t const first = member_[body.members];
  for (std::size_t k = 0; k < body.size; ++k) {
    std::uint32_t const i = member_[body.members + k];
    Vector<3> way = between(first, i) - (arms[k] - arms[0]);
    bool across = false;
    for (std::size_t a = 0; a < D; ++a) across = across || std::abs(way[a]) > 0.5 * box_.length(static_cast<int>(a));
    if (across) box_.nearest_image(way.component);
    double const m = ensemble_.row(i)[mass_];
    moved.all()[k] = way;
    masses.all()[k] = m;
    centre += way * m;
    torque += cross(arms[k], way) * m;
    mass += m;
  }
  centre *= 1 / mass;
  Scratch<Vector<3>> ways(body.size);
  if (!turn_by(torque, shapes_[body.shape].line, masses.all(), arms, ways.all())) return false;
  for (std::size_t k = 0; k < body.size; ++k) {
    Member const p = member(member_[body.members + k]);
    Vector<3> const change = centre + ways.all()[k] - moved.all()[k];
    for (std::size_t a = 0; a < D; ++a) p.position[a] += change[a], p.velocity[a] += change[a] * per_time;
  }
  return true;
}

RigidBonds::BodyMotion RigidBonds::motion_of(Molecule const& body, std::span<Vector<3> const> arms) const {
  auto const D = static_cast<std::size_t>(box_.dimension());
  Scratch<double> masses(body.size);
  BodyMotion motion;
  Vector<3> spin{0, 0, 0};  // angular momentum
  for (std::size_t k = 0; k < body.size; ++k) {
    double const* const row = ensemble_.row(member_[body.members + k]);
    double const m = masses.all()[k] = row[mass_];
    Vector<3> momentum{0, 0, 0};
    for (std::size_t a = 0; a < D; ++a) momentum[a] = m * row[static_cast<std::size_t>(velocity_) + a];
    motion.mass += m;
    motion.velocity += momentum;
    spin += cross(arms[k], momentum);  // arms have zero mean, so the velocity of the centre cancels
  }
  motion.velocity *= 1 / motion.mass;
  motion.inertia = inertia_of(arms, masses.all());
  motion.rotation = solved(motion.inertia, shapes_[body.shape].line, spin);
  return motion;
}

/// Projects the velocities onto those of a body; the result is the nearest in kinetic energy.
std::optional<double> RigidBonds::correct_body_velocities(Molecule const& body) {
  auto const D = static_cast<std::size_t>(box_.dimension());
  auto const arms = noted_arms(body);
  arms_of(body, arms);
  BodyMotion const motion = motion_of(body, arms);
  double lost = 0;
  for (std::size_t k = 0; k < body.size; ++k) {
    double* const row = ensemble_.row(member_[body.members + k]);
    Vector<3> const rigid = motion.velocity + cross(motion.rotation, arms[k]);
    for (std::size_t a = 0; a < D; ++a) {
      double& v = row[static_cast<std::size_t>(velocity_) + a];
      lost += 0.5 * row[mass_] * (v - rigid[a]) * (v - rigid[a]);
      v = rigid[a];
    }
  }
  return -lost;
}

/// The constraint force on a particle is its mass times its acceleration in the body, minus its influence.
void RigidBonds::add_body_virial(Molecule const& body, std::vector<Vector<3>> const& acceleration,
                                 std::vector<double>& per_particle) const {
  std::vector<Vector<3>> arms(body.size);
  arms_of(body, arms);
  BodyMotion const motion = motion_of(body, arms);
  Vector<3> force{0, 0, 0}, torque{0, 0, 0};
  for (std::size_t k = 0; k < body.size; ++k) {
    std::uint32_t const i = member_[body.members + k];
    Vector<3> const pull = acceleration[i] * ensemble_.row(i)[mass_];
    force += pull;
    torque += cross(arms[k], pull);
  }
  Vector<3> const &w = motion.rotation, spin = product(motion.inertia, w);
  Vector<3> const turning = solved(motion.inertia, shapes_[body.shape].line, torque - cross(w, spin));
  for (std::size_t k = 0; k < body.size; ++k) {
    std::uint32_t const i = member_[body.members + k];
    Vector<3> const& arm = arms[k];
    Vector<3> const rigid = force * (1 / motion.mass) + cross(turning, arm) + cross(w, cross(w, arm));
    Vector<3> const held = (rigid - acceleration[i]) * ensemble_.row(i)[mass_];
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b)
        per_particle[9 * i + 3 * a + b] += 0.5 * (arm[a] * held[b] + arm[b] * held[a]);
  }
}

}  // namespace boltzmann
