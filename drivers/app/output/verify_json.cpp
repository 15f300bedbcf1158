// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/app/output/row_json.hpp>
#include <plica/drivers/app/output/verify_json.hpp>

namespace plica::app {

using Json = nlohmann::ordered_json;

namespace {

Json row_head(const VerifyRow& row) {
  return {{"problem", row.problem},
          {"quantity", row.quantity},
          {"unit", row.unit},
          {"accepted", row_value(row.accepted)},
          {"source", row_value(row.source)}};
}

Json row_end(const VerifyRow& row) {
  return {{"limit", row_value(row.limit)},
          {"order", row_value(row.order)},
          {"judged", judged_name(row.judged)},
          {"tolerance", row.judged == Judged::nothing || row.judged == Judged::above ? Json() : Json(row.tolerance)},
          {"outcome", row.outcome},
          {"ok", row.outcome != "not ok"},
          {"note", row_value(row.note)}};
}

}  // namespace

std::string judged_name(Judged judged) {
  switch (judged) {
    case Judged::finest:
      return "finest";
    case Judged::limit:
      return "limit";
    case Judged::size:
      return "size";
    case Judged::order:
      return "order";
    case Judged::above:
      return "above";
    case Judged::nothing:
      break;
  }
  return "nothing";
}

std::string verify_json(const VerifyHead& head, const VerifyResult& result) {
  Json json = {{"status", head.status},       {"ok", result.ok()},
               {"small", head.small},         {"machine", machine_json(head.machine)},
               {"wall_time", head.wall_time}, {"rows", Json::array()}};
  for (const VerifyRow& row : result.rows) {
    Json one = row_head(row);
    one["ours"] = Json::array();
    for (const VerifyValue& v : row.ours)
      one["ours"].push_back({{"mesh", v.mesh}, {"size", v.size}, {"value", v.value}});
    one.update(row_end(row));
    json["rows"].push_back(one);
  }
  return json.dump(2) + "\n";
}

std::string verify_csv(const VerifyResult& result) {
  Json rows = Json::array();
  for (const VerifyRow& row : result.rows)
    for (const VerifyValue& v : row.ours) {
      Json one = row_head(row);
      one["mesh"] = v.mesh, one["size"] = v.size, one["value"] = v.value;
      one.update(row_end(row));
      rows.push_back(one);
    }
  return csv_table(rows);
}

}  // namespace plica::app
