"""The one folder that speaks RDF: reading, matching and writing of advertisements, templates and configurations."""
