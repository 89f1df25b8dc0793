#include "canyon/scene/importers/parsing/xml_file.h"

#include <libxml/SAX2.h>
#include <libxml/parser.h>
#include <libxml/tree.h>

#include "canyon/core/files/files.h"
#include "canyon/core/process/progress.h"

namespace canyon::scene {
namespace {

const xmlNode* as_node(const void* node) {
  return static_cast<const xmlNode*>(node);
}

const xmlNode* element_from(const xmlNode* node) {
  while (node != nullptr && node->type != XML_ELEMENT_NODE) node = node->next;
  return node;
}

/// What stops the parser before the end. libxml2 calls back from C: nothing may be thrown through it.
struct Stop {
  bool declares = false, cancelled = false;
  int line = 0;
};

void stop(void* context, bool Stop::*why) {
  auto* parser = static_cast<xmlParserCtxt*>(context);
  auto* found = static_cast<Stop*>(parser->_private);
  found->*why = true;
  found->line = parser->input == nullptr ? 0 : parser->input->line;
  xmlStopParser(parser);
}

/// Entities that hold one another, and default attributes, let a short file grow without bounds. No scene needs them.
void refuse_entity(void* context, const xmlChar*, int, const xmlChar*, const xmlChar*, xmlChar*) {
  stop(context, &Stop::declares);
}
void refuse_attribute(void* context, const xmlChar*, const xmlChar*, int, int, const xmlChar*, xmlEnumeration* values) {
  xmlFreeEnumeration(values);
  stop(context, &Stop::declares);
}

void start_element(void* context, const xmlChar* name, const xmlChar* prefix, const xmlChar* uri, int namespaces,
                   const xmlChar** namespace_list, int attributes, int defaulted, const xmlChar** attribute_list) {
  if (cancel_requested()) return stop(context, &Stop::cancelled);
  xmlSAX2StartElementNs(context, name, prefix, uri, namespaces, namespace_list, attributes, defaulted, attribute_list);
}

}  // namespace

std::string_view XmlElement::name() const {
  return reinterpret_cast<const char*>(as_node(node_)->name);
}

int XmlElement::line() const {
  return static_cast<int>(xmlGetLineNo(as_node(node_)));
}

std::optional<std::string> XmlElement::attribute(const char* name) const {
  for (const xmlAttr* a = as_node(node_)->properties; a != nullptr; a = a->next) {
    if (std::string_view(reinterpret_cast<const char*>(a->name)) != name) continue;
    std::string value;
    for (const xmlNode* part = a->children; part != nullptr; part = part->next)
      if (part->content != nullptr) value += reinterpret_cast<const char*>(part->content);
    return value;
  }
  return std::nullopt;
}

std::string XmlElement::text() const {
  xmlChar* content = xmlNodeGetContent(as_node(node_));
  std::string out = content == nullptr ? "" : reinterpret_cast<const char*>(content);
  xmlFree(content);
  return out;
}

XmlElement XmlElement::first_child() const {
  return XmlElement(element_from(as_node(node_)->children));
}

XmlElement XmlElement::next() const {
  return XmlElement(element_from(as_node(node_)->next));
}

XmlElement XmlElement::child(std::string_view name) const {
  for (XmlElement e = first_child(); e; e = e.next())
    if (e.name() == name) return e;
  return {};
}

void XmlElement::walk(const std::function<bool(const XmlElement&)>& visit) const {
  for (XmlElement e = first_child(); e; e = e.next())
    if (visit(e)) e.walk(visit);
}

Result<XmlFile> XmlFile::load(const std::string& path) {
  CANYON_TRY(const std::string text, read_text_or_gzip_file(path));
  if (text.size() > 2'000'000'000u) return Error{path, 0, "", "larger than 2 GB", "a smaller file"};
  xmlParserCtxt* context = xmlNewParserCtxt();
  CANYON_CHECK(context != nullptr, "libxml2 could not be started");
  Stop stopped;
  context->_private = &stopped;
  context->sax->entityDecl = refuse_entity;
  context->sax->attributeDecl = refuse_attribute;
  context->sax->startElementNs = start_element;
  // Without XML_PARSE_HUGE: elements at most 256 deep, which also bounds our own recursion, and 10 MB for one text.
  xmlDoc* document = xmlCtxtReadMemory(
      context, text.data(), static_cast<int>(text.size()), path.c_str(), nullptr,
      XML_PARSE_NONET | XML_PARSE_NOERROR | XML_PARSE_NOWARNING | XML_PARSE_COMPACT | XML_PARSE_BIG_LINES);
  const int line = context->lastError.line;
  const std::string why = context->lastError.message == nullptr ? "" : context->lastError.message;
  xmlFreeParserCtxt(context);
  if (stopped.cancelled || stopped.declares) xmlFreeDoc(document);
  if (stopped.cancelled) throw Cancelled{};
  if (stopped.declares)
    return Error{path, stopped.line, "DOCTYPE", "declares entities or attributes",
                 "XML without declarations of its own"};
  if (document == nullptr && why.find("depth") != std::string::npos)
    return Error{path, line, "", "elements more than 256 deep", "a scene"};
  if (document == nullptr) return Error{path, line, "", "not valid XML", "XML text"};
  XmlFile file;
  file.document_ = std::shared_ptr<const void>(
      document, [](const void* d) { xmlFreeDoc(const_cast<xmlDoc*>(static_cast<const xmlDoc*>(d))); });
  if (!file.root()) return Error{path, 0, "", "holds no XML element", "XML text"};
  return file;
}

XmlElement XmlFile::root() const {
  return XmlElement(xmlDocGetRootElement(const_cast<xmlDoc*>(static_cast<const xmlDoc*>(document_.get()))));
}

}  // namespace canyon::scene
