// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/dds/qos_overrides.hpp"

#include <fastrtps/xmlparser/XMLParser.h>
#include <fastrtps/xmlparser/XMLTree.h>
#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "components/runtime/config/config.hpp"
#include "components/runtime/dds/dds_log.hpp"
#include "components/runtime/dds/qos_policies.hpp"
#include "components/runtime/names.hpp"
#include "components/runtime/qos.hpp"

namespace swiftlet {

namespace dds = eprosima::fastdds::dds;
namespace xml = eprosima::fastrtps::xmlparser;

namespace {

/// What Fast DDS makes of one profile in a document of its own; null where it refuses it.
template <class Attributes>
std::unique_ptr<Attributes> parsed(tinyxml2::XMLDocument& document) {
  xml::up_base_node_t root;
  if (xml::XMLParser::loadXML(document, root) != xml::XMLP_ret::XML_OK || !root) return nullptr;
  // root, profiles, profile
  for (xml::BaseNode* node = root.get(); node != nullptr;) {
    if (auto* data = dynamic_cast<xml::DataNode<Attributes>*>(node)) return data->getData();
    node = node->getNumChildren() == 0 ? nullptr : node->getChild(0);
  }
  return nullptr;
}

}  // namespace

/// Reads one file. Fast DDS parses each policy by itself, so that it is known which policies are
/// present, and on which line one stands that it refuses.
class QosOverridesReader {
 public:
  QosOverridesReader(const std::string& file, const QosOverrides::Names& names)
      : file_(file), names_(names) {}

  QosOverrides read() {
    std::error_code ignored;  // such as a name that is too long
    if (!std::filesystem::is_regular_file(file_, ignored)) {
      throw ConfigError(fmt::format("{}: there is no such file", file_));
    }
    tinyxml2::XMLDocument document;
    if (document.LoadFile(file_.c_str()) != tinyxml2::XML_SUCCESS) {
      const std::string reason = document.ErrorStr() == nullptr ? "" : document.ErrorStr();
      throw ConfigError(fmt::format("{}:{}: this is not XML: {}", file_,
                                    std::max(1, document.ErrorLineNum()), reason));
    }
    const tinyxml2::XMLElement* root = document.RootElement();
    if (root == nullptr) {
      throw ConfigError(fmt::format("{}:1: there is no element; wanted is <dds>", file_));
    }
    const std::string name = root->Name();
    if (name == "profiles") {
      read_profiles(*root);
    } else if (name == "dds") {
      for (auto* child = root->FirstChildElement(); child; child = child->NextSiblingElement()) {
        if (std::string(child->Name()) != "profiles") refuse(*child, "<profiles>");
        read_profiles(*child);
      }
    } else {
      refuse(*root, "<dds> or <profiles>");
    }
    return std::move(overrides_);
  }

 private:
  using Element = tinyxml2::XMLElement;

  [[noreturn]] void fail(const Element& at, const std::string& problem) const {
    throw ConfigError(fmt::format("{}:{}: {}", file_, at.GetLineNum(), problem));
  }
  [[noreturn]] void refuse(const Element& element, const std::string& wanted) const {
    fail(element, fmt::format("<{}> has no meaning here; wanted is {}", element.Name(), wanted));
  }

  void read_profiles(const Element& profiles) {
    for (auto* child = profiles.FirstChildElement(); child; child = child->NextSiblingElement()) {
      const std::string kind = child->Name();
      if (kind == "data_writer" || kind == "publisher") {
        read_profile(*child, writer_policies(), overrides_.writers_);
      } else if (kind == "data_reader" || kind == "subscriber") {
        read_profile(*child, reader_policies(), overrides_.readers_);
      } else {
        // Transports and participants are chosen by --network.
        refuse(*child, "<data_writer> or <data_reader>");
      }
    }
  }

  /// The key under which a profile is kept: its own name, or that of the topic on the wire.
  std::string key_of(const Element& profile) const {
    const char* attribute = profile.Attribute("profile_name");
    const std::string name = attribute == nullptr ? "" : attribute;
    if (name.empty()) fail(profile, fmt::format("this <{}> has no profile_name", profile.Name()));
    if (profile.BoolAttribute("is_default_profile")) {
      fail(profile, "is_default_profile has no meaning here; name a profile or a topic");
    }
    if (name.compare(0, 3, "rt/") == 0) return name;
    std::vector<std::string> known = names_.topics;
    for (const QosProfile* ours : qos::profiles) {
      if (name == ours->name) return name;
      known.emplace_back(ours->name);
    }
    const auto& topics = names_.topics;
    if (std::find(topics.begin(), topics.end(), name) != topics.end()) {
      return wire_topic(names_.vehicle, name);
    }
    const std::string near = nearest_word(name, known);
    fail(profile,
         fmt::format("'{}' is neither a profile (sensor, state, command, map, event, bulk) "
                     "nor a topic{}",
                     name, near.empty() ? "" : fmt::format("; did you mean '{}'?", near)));
  }

  template <class Attributes, class Qos>
  void read_profile(const Element& profile, const Policies<Attributes, Qos>& policies,
                    QosOverrides::ByName<Qos>& by_name) {
    const std::string key = key_of(profile);
    const auto [entry, is_new] = by_name.try_emplace(key);
    if (!is_new) fail(profile, fmt::format("there is a second <{}> for '{}'", profile.Name(), key));
    std::map<std::string, std::function<void(Qos&)>> found;  // by path: in a fixed order
    std::vector<const Element*> path{&profile};
    read_policies("", path, policies, found, entry->second.partitions);
    for (auto& [name, change] : found) entry->second.policies.push_back(std::move(change));
  }

  /// Looks for policies below the last element of `path`.
  template <class Attributes, class Qos>
  void read_policies(const std::string& prefix, std::vector<const Element*>& path,
                     const Policies<Attributes, Qos>& policies,
                     std::map<std::string, std::function<void(Qos&)>>& found,
                     std::vector<std::string>& partitions) {
    for (auto* child = path.back()->FirstChildElement(); child;
         child = child->NextSiblingElement()) {
      const std::string name = prefix + child->Name();
      path.push_back(child);
      const auto policy = policies.find(name);
      if (policy != policies.end()) {
        auto attributes = std::shared_ptr<const Attributes>(parse<Attributes>(path));
        check(*child, *attributes);
        if (name == kPartitionPolicy) partitions = attributes->qos.m_partition.getNames();
        const bool is_new = found
                                .emplace(name, [attributes, change = policy->second](
                                                   Qos& qos) { change(*attributes, qos); })
                                .second;
        if (!is_new) fail(*child, fmt::format("<{}> stands here for a second time", child->Name()));
      } else {
        const auto below = policies.lower_bound(name + "/");
        const bool leads_on = below != policies.end() && below->first.rfind(name + "/", 0) == 0;
        if (!leads_on) refuse_policy(*child, prefix, policies);
        read_policies(name + "/", path, policies, found, partitions);
      }
      path.pop_back();
    }
  }

  template <class P>
  [[noreturn]] void refuse_policy(const Element& element, const std::string& prefix,
                                  const P& policies) const {
    std::set<std::string> possible;
    for (const auto& [name, change] : policies) {
      if (name.rfind(prefix, 0) != 0) continue;
      const std::string rest = name.substr(prefix.size());
      possible.insert("<" + rest.substr(0, rest.find('/')) + ">");
    }
    refuse(element, fmt::format("one of {}", fmt::join(possible, " ")));
  }

  /// Lets Fast DDS read the last element of `path`, alone in its profile.
  template <class Attributes>
  std::unique_ptr<Attributes> parse(const std::vector<const Element*>& path) const {
    tinyxml2::XMLDocument document;
    tinyxml2::XMLNode* parent = document.InsertEndChild(document.NewElement("dds"));
    parent = parent->InsertEndChild(document.NewElement("profiles"));
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
      parent = parent->InsertEndChild(path[i]->ShallowClone(&document));
    }
    parent->InsertEndChild(path.back()->DeepClone(&document));
    auto attributes = parsed<Attributes>(document);
    if (attributes == nullptr) {
      const char* text = path.back()->GetText();
      fail(*path.back(), fmt::format("Fast DDS cannot read <{}>{}", path.back()->Name(),
                                     text == nullptr ? "" : fmt::format(" '{}'", text)));
    }
    return attributes;
  }

  /// What Fast DDS can read but would not keep to.
  template <class Attributes>
  void check(const Element& element, const Attributes& attributes) const {
    if (attributes.qos.m_durability.kind > dds::TRANSIENT_LOCAL_DURABILITY_QOS) {
      fail(element, "only VOLATILE and TRANSIENT_LOCAL can be had: there is no durability service");
    }
    if (attributes.topic.historyQos.depth < 1) fail(element, "the depth must be at least 1");
    if (attributes.qos.data_sharing.kind() == dds::DataSharingKind::ON) {
      fail(element, "data sharing is used wherever it can be; it can only be turned OFF");
    }
  }

  std::string file_;
  QosOverrides::Names names_;
  QosOverrides overrides_;
};

QosOverrides QosOverrides::load(const std::string& file, const Names& names) {
  bridge_dds_log();
  return QosOverridesReader(file, names).read();
}

namespace {

/// First the profile, then the topic, which wins.
template <class ByName, class Use>
void for_each_match(const ByName& by_name, const std::string& topic, const std::string& profile,
                    Use use) {
  for (const std::string& key : {profile, topic}) {
    const auto found = by_name.find(key);
    if (found != by_name.end()) use(found->second);
  }
}

template <class ByName, class Qos>
void apply_all(const ByName& by_name, const std::string& topic, const std::string& profile,
               Qos& qos) {
  for_each_match(by_name, topic, profile, [&](const auto& changes) {
    for (const auto& change : changes.policies) change(qos);
  });
}

template <class ByName>
std::vector<std::string> partitions_of(const ByName& by_name, const std::string& topic,
                                       const std::string& profile) {
  std::vector<std::string> partitions;
  for_each_match(by_name, topic, profile, [&](const auto& changes) {
    if (!changes.partitions.empty()) partitions = changes.partitions;
  });
  return partitions;
}

}  // namespace

void QosOverrides::apply(const std::string& topic, const std::string& profile,
                         dds::DataWriterQos& qos) const {
  apply_all(writers_, topic, profile, qos);
}
void QosOverrides::apply(const std::string& topic, const std::string& profile,
                         dds::DataReaderQos& qos) const {
  apply_all(readers_, topic, profile, qos);
}
std::vector<std::string> QosOverrides::writer_partitions(const std::string& topic,
                                                         const std::string& profile) const {
  return partitions_of(writers_, topic, profile);
}
std::vector<std::string> QosOverrides::reader_partitions(const std::string& topic,
                                                         const std::string& profile) const {
  return partitions_of(readers_, topic, profile);
}

}  // namespace swiftlet
