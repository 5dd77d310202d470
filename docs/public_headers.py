"""What stands in a public header, as directives of breathe, from Doxygen's XML."""

import os
import xml.etree.ElementTree

DIRECTIVES = {kind: "doxygen" + kind for kind in ("function", "enum", "typedef", "variable")}


class PublicHeaders:
    def __init__(self, folder):
        self._folder = folder
        self._classes, self._members = {}, {}
        for compound in self._read("index").findall("compound"):
            if compound.get("kind") in ("class", "struct"):
                self._add_class(self._read(compound.get("refid")).find("compounddef"))
            elif compound.get("kind") == "namespace":
                for member in self._read(compound.get("refid")).iter("memberdef"):
                    self._members.setdefault(member.find("location").get("file"), []).append(member)

    def _read(self, name):
        return xml.etree.ElementTree.parse(os.path.join(self._folder, name + ".xml")).getroot()

    def _add_class(self, definition):
        # One that stands inside of another is shown there.
        self._classes.setdefault(definition.find("location").get("file"), []).append(definition)

    def _is_inner(self, name):
        outer = name.rpartition("::")[0]
        return any(one.findtext("compoundname") == outer for some in self._classes.values() for one in some)

    def directives(self, header):
        """Of everything in a header, in the order of its lines."""
        entries = []
        for definition in self._classes.get(header, []):
            name = definition.findtext("compoundname")
            if not self._is_inner(name) and "<" not in name:
                kind = "doxygen" + definition.get("kind")
                directive = ".. %s:: %s\n   :members:\n   :undoc-members:\n" % (kind, name)
                entries.append((definition.find("location"), directive))
        for member in self._members.get(header, []):
            name = member.findtext("qualifiedname")
            if member.get("kind") == "function":
                name += self._arguments(member)
            entries.append((member.find("location"), ".. %s:: %s\n" % (DIRECTIVES[member.get("kind")], name)))
        if not entries:
            raise LookupError("nothing documented in the public header '%s'" % header)
        entries.sort(key=lambda entry: int(entry[0].get("line")))
        return "\n".join(text for _, text in entries)

    @staticmethod
    def _arguments(function):
        types = ["".join(parameter.find("type").itertext()) for parameter in function.findall("param")]
        return "(" + ", ".join(types) + ")"

    def files(self):
        return set(self._classes) | set(self._members)
