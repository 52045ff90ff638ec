#include <slideway/io/text.hpp>
#include <slideway/oracle/reference.hpp>
#include <stdexcept>

namespace slideway::oracle {
namespace {

constexpr int written_digits = 32;

/// The quantities of an instant, by their names in JSON.
const std::vector<std::pair<const char*, std::vector<Real> Instant<Real>::*>> vectors = {
    {"q", &Instant<Real>::q},           {"v", &Instant<Real>::v},
    {"lambda", &Instant<Real>::lambda}, {"friction", &Instant<Real>::friction},
    {"drive", &Instant<Real>::drive},   {"pin", &Instant<Real>::pin}};
const std::vector<std::pair<const char*, Real Instant<Real>::*>> scalars = {
    {"energy", &Instant<Real>::energy}, {"work", &Instant<Real>::work}, {"dissipated", &Instant<Real>::dissipated}};

std::string text(const Real& x) { return x.str(written_digits, std::ios_base::scientific); }

Real number(const io::Json& json) { return Real(json.get<std::string>()); }

std::string checksum(io::Json json) {
  json.erase("checksum");
  return io::fnv1a(json.dump());
}

}  // namespace

Reference make_reference(const io::SceneFile& scene, const std::function<void(double)>& progress) {
  Reference reference{scene.name, scene.hash, scene.run.duration, 0, {}};
  const auto model = model_of<Real>(scene.scene);
  std::vector<Real> times;
  const Real duration(reference.duration);
  for (int i = 0; i <= reference_intervals; ++i) times.push_back(duration * i / reference_intervals);
  TrajectoryOptions options;
  options.progress = [&](double t) { progress(t / reference.duration); };
  Validated validated = integrate_twice(model, duration, times, options);
  reference.trajectory = std::move(validated.trajectory);
  reference.digits = validated.digits;
  return reference;
}

io::Json to_json(const Reference& reference) {
  io::Json json{{"format", io::json_format},
                {"scene", reference.scene},
                {"hash", reference.hash},
                {"obtained",
                 "Taylor series in 50-digit arithmetic, events located as roots of the series; two runs, of different "
                 "order and step, share the digits given in every number"},
                {"duration", reference.duration},
                {"digits", std::floor(reference.digits)}};
  io::Json events = io::Json::array();
  for (const auto& event : reference.trajectory.events) {
    events.push_back(
        {{"t", text(event.t)}, {"guide", event.guide}, {"contact", event.contact}, {"kind", name(event.kind)}});
  }
  json["events"] = events;
  io::Json samples = io::Json::array();
  for (const Instant<Real>& sample : reference.trajectory.samples) {
    io::Json one{{"t", text(sample.t)}};
    for (const auto& [key, member] : vectors) {
      io::Json list = io::Json::array();
      for (const Real& x : sample.*member) list.push_back(text(x));
      one[key] = list;
    }
    for (const auto& [key, member] : scalars) one[key] = text(sample.*member);
    samples.push_back(one);
  }
  json["samples"] = samples;
  json["checksum"] = checksum(json);
  return json;
}

Reference reference_of(const io::Json& json) {
  if (json.value("checksum", "") != checksum(json)) throw std::runtime_error("the checksum does not fit the data");
  Reference reference{json.at("scene"), json.at("hash"), json.at("duration"), json.at("digits"), {}};
  for (const io::Json& event : json.at("events")) {
    EventKind kind = EventKind::slip_reversal;
    for (const EventKind other : {EventKind::stick, EventKind::slip, EventKind::normal_reversal}) {
      if (event.at("kind") == name(other)) kind = other;
    }
    reference.trajectory.events.push_back({number(event.at("t")), event.at("guide"), event.at("contact"), kind});
  }
  for (const io::Json& sample : json.at("samples")) {
    Instant<Real> one{};
    one.t = number(sample.at("t"));
    for (const auto& [key, member] : vectors) {
      for (const io::Json& x : sample.at(key)) (one.*member).push_back(number(x));
    }
    for (const auto& [key, member] : scalars) one.*member = number(sample.at(key));
    reference.trajectory.samples.push_back(one);
  }
  reference.trajectory.t = Real(reference.duration);
  return reference;
}

}  // namespace slideway::oracle
