-- For the rendered page: numbers of equations, and links that hold without the tree.

-- MathML knows no \tag: the number stands at the margin.
function Math(math)
  local number = math.text:match("\\tag{([^}]*)}")
  if not number then return nil end
  math.text = math.text:gsub("\\tag{[^}]*}", "")
  return pandoc.Span(
    { math, pandoc.Span({ pandoc.Str("(" .. number .. ")") }, pandoc.Attr("", { "number" })) },
    pandoc.Attr("", { "equation" }))
end

-- Links between chapters become links within the page; links to other files of the project are
-- shown as their names, for the page is read without the tree.
function Link(link)
  local chapter, place = link.target:match("^([%w-]+)%.md(#?.*)$")
  if chapter then
    link.target = place ~= "" and place or "#chapter-" .. chapter
    return link
  end
  if link.target:match("^%a+:") or link.target:match("^#") then return link end
  return link.content
end
