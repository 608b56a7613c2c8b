//! `#[derive(Keys)]`: a struct whose fields are the keys of a table in a model; `#[derive(Sides)]`: the keys that joints have in common.
//!
//! The documentation of a field is that of its key, and `Option` says that the key may be left out. What else is known of a key stands
//! in `#[key(unit = "…", default = "…", shape = …)]`: the unit for people, what is taken when the key is not there, and what its value
//! looks like where the type of the field does not say it. `#[table("a term")]` says what messages call the table, and
//! `#[table("a shape", function)]` also what refuses a value that is no table. With `#[kind(name = "…", equations = "…",
//! example = "…")]` the struct is a kind: what `type` may say.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use syn::{Attribute, Data, DeriveInput, Error, Expr, Field, Fields, Ident, LitStr, Result, Type, parse_macro_input};

/// Implements `Keys`, and `Field` for use inside of other tables; of a kind also `Described`.
#[proc_macro_derive(Keys, attributes(key, kind, table))]
pub fn derive_keys(input: proc_macro::TokenStream) -> proc_macro::TokenStream {
    let input = parse_macro_input!(input as DeriveInput);
    keys(&input).unwrap_or_else(Error::into_compile_error).into()
}

/// Implements `Sides` from the fields `between`, `at`, and `axis` or `axes`.
#[proc_macro_derive(Sides)]
pub fn derive_sides(input: proc_macro::TokenStream) -> proc_macro::TokenStream {
    let input = parse_macro_input!(input as DeriveInput);
    sides(&input).unwrap_or_else(Error::into_compile_error).into()
}

fn sides(input: &DeriveInput) -> Result<TokenStream> {
    let fields = fields(input)?;
    let site = |names: &[&str]| {
        let field = fields.iter().find(|field| field.ident.as_ref().is_some_and(|ident| names.iter().any(|name| ident == name)));
        match field {
            Some(Field { ident, ty, .. }) if optional(ty).is_some() => quote! { self.#ident.as_ref() },
            Some(Field { ident, .. }) => quote! { Some(&self.#ident) },
            None => quote! { None },
        }
    };
    let (ident, at, directions) = (&input.ident, site(&["at"]), site(&["axis", "axes"]));
    Ok(quote! {
        impl ::holonom::model::joints::Sides for #ident {
            fn between(&self) -> &[String] {
                &self.between
            }

            fn at(&self) -> Option<&::holonom::model::Site> {
                #at
            }

            fn directions(&self) -> Option<&::holonom::model::Site> {
                #directions
            }
        }
    })
}

/// A field with what is known of its key.
struct Known<'a> {
    ident: &'a Ident,
    name: String,
    /// The type of the value, inside of an `Option`.
    value: &'a Type,
    is_optional: bool,
    doc: String,
    unit: String,
    default: String,
    shape: Option<Expr>,
}

fn fields(input: &DeriveInput) -> Result<Vec<&Field>> {
    let Data::Struct(data) = &input.data else { return Err(Error::new_spanned(input, "keys are the fields of a struct")) };
    match &data.fields {
        Fields::Named(named) => Ok(named.named.iter().collect()),
        Fields::Unit => Ok(Vec::new()),
        Fields::Unnamed(_) => Err(Error::new_spanned(input, "keys are named fields")),
    }
}

fn keys(input: &DeriveInput) -> Result<TokenStream> {
    let fields = fields(input)?.into_iter().map(known).collect::<Result<Vec<_>>>()?;
    let ident = &input.ident;
    let kind = kind(ident, &input.attrs)?;
    let table = table(ident, &fields, &inside(&input.attrs)?, kind.is_some());
    let builder = builder(ident, &fields);
    Ok(quote! { #table #builder #kind })
}

/// The traits by which a table is read and written.
fn table(ident: &Ident, fields: &[Known<'_>], inside: &Inside, is_kind: bool) -> TokenStream {
    let what = &inside.what;
    let otherwise = match &inside.otherwise {
        Some(function) => quote! { #function(entry, spot, other) },
        None => quote! { entry.refuse_no_table(spot, other) },
    };
    let of_type = is_kind.then(|| quote! { "type" => Some(::holonom::model::Value::text(<Self as ::holonom::model::Described>::NAME)), });
    let keys = fields.iter().map(|Known { name, value, is_optional, doc, unit, default, shape, .. }| {
        let shape = shape.as_ref().map_or(quote! { <#value as ::holonom::model::Field>::SHAPE }, |shape| quote! { #shape });
        let required = !is_optional;
        quote! {
            ::holonom::model::Key { name: #name, shape: #shape, required: #required, default: #default, unit: #unit, doc: #doc }
        }
    });
    let locals: Vec<Ident> = fields.iter().map(|field| format_ident!("of_{}", field.name)).collect();
    let reads = fields.iter().map(|Known { name, is_optional, .. }| match is_optional {
        true => quote! { reader.may_have(#name) },
        false => quote! { reader.must_have(#name) },
    });
    let idents: Vec<&Ident> = fields.iter().map(|field| field.ident).collect();
    let writes = fields.iter().map(|Known { ident, name, is_optional, .. }| match is_optional {
        true => quote! { #name => self.#ident.as_ref().map(::holonom::model::Field::write) },
        false => quote! { #name => Some(::holonom::model::Field::write(&self.#ident)) },
    });
    quote! {
        impl ::holonom::model::Keys for #ident {
            const KEYS: &'static [::holonom::model::Key] = &[#(#keys),*];

            fn read(reader: &::holonom::model::Reader<'_>) -> ::holonom::model::Read<Self> {
                #(let #locals = #reads;)*
                Ok(Self { #(#idents: #locals?),* })
            }
        }

        impl ::holonom::model::Written for #ident {
            fn value(&self, key: &str) -> Option<::holonom::model::Value> {
                match key {
                    #(#writes,)*
                    #of_type
                    _ => None,
                }
            }
        }

        impl ::holonom::model::Field for #ident {
            const SHAPE: ::holonom::model::Shape = ::holonom::model::Shape::Table(<Self as ::holonom::model::Keys>::KEYS);
            const LIST: ::holonom::model::Shape = ::holonom::model::Shape::Tables(<Self as ::holonom::model::Keys>::KEYS);

            fn read(
                entry: &::holonom::model::Entry<'_>,
                spot: ::holonom::model::Spot<'_>,
                value: &::holonom::model::Value,
            ) -> ::holonom::model::Read<Self> {
                match value {
                    ::holonom::model::Value::Table(table) => entry.read_inside(#what, spot, table),
                    other => Err(#otherwise),
                }
            }

            fn write(&self) -> ::holonom::model::Value {
                ::holonom::model::Value::Table(::holonom::model::Keys::write(self))
            }
        }
    }
}

/// `new` with what must be there, and a method for each key that may be left out.
fn builder(ident: &Ident, fields: &[Known<'_>]) -> TokenStream {
    let needed: Vec<&Known<'_>> = fields.iter().filter(|field| !field.is_optional).collect();
    let parameters = needed.iter().map(|Known { ident, value, .. }| quote! { #ident: impl Into<#value> });
    let values = fields.iter().map(|Known { ident, is_optional, .. }| match is_optional {
        true => quote! { #ident: None },
        false => quote! { #ident: #ident.into() },
    });
    let setters = fields.iter().filter(|field| field.is_optional).map(|Known { ident, value, doc, .. }| {
        quote! {
            #[doc = #doc]
            #[must_use]
            pub fn #ident(mut self, #ident: impl Into<#value>) -> Self {
                self.#ident = Some(#ident.into());
                self
            }
        }
    });
    quote! {
        impl #ident {
            /// With what must be given; everything else as it is without its key.
            #[allow(clippy::new_without_default)]
            pub fn new(#(#parameters),*) -> Self {
                Self { #(#values),* }
            }

            #(#setters)*
        }
    }
}

/// Name, documentation, equations and example of a kind.
fn kind(ident: &Ident, attributes: &[Attribute]) -> Result<Option<TokenStream>> {
    let Some(attribute) = attributes.iter().find(|attribute| attribute.path().is_ident("kind")) else { return Ok(None) };
    let (mut name, mut equations, mut example) = (None, None, None);
    attribute.parse_nested_meta(|meta| {
        let text: LitStr = meta.value()?.parse()?;
        match () {
            () if meta.path.is_ident("name") => name = Some(text),
            () if meta.path.is_ident("equations") => equations = Some(text),
            () if meta.path.is_ident("example") => example = Some(text),
            () => return Err(meta.error("a kind has `name`, `equations` and `example`")),
        }
        Ok(())
    })?;
    let (Some(name), Some(equations), Some(example)) = (name, equations, example) else {
        return Err(Error::new_spanned(attribute, "a kind has `name`, `equations` and `example`"));
    };
    let doc = documentation(attributes);
    Ok(Some(quote! {
        impl ::holonom::model::Described for #ident {
            const NAME: &'static str = #name;
            const DOC: &'static str = #doc;
            const EQUATIONS: &'static str = #equations;
            const EXAMPLE: &'static str = #example;
        }
    }))
}

/// What stands in `#[table(…)]`.
struct Inside {
    what: String,
    otherwise: Option<syn::Path>,
}

fn inside(attributes: &[Attribute]) -> Result<Inside> {
    let Some(table) = attributes.iter().find(|attribute| attribute.path().is_ident("table")) else {
        return Ok(Inside { what: "this table".into(), otherwise: None });
    };
    table.parse_args_with(|input: syn::parse::ParseStream<'_>| {
        let what = input.parse::<LitStr>()?.value();
        let otherwise = match input.parse::<Option<syn::Token![,]>>()? {
            Some(_) => Some(input.parse()?),
            None => None,
        };
        Ok(Inside { what, otherwise })
    })
}

fn known(field: &Field) -> Result<Known<'_>> {
    let ident = field.ident.as_ref().expect("fields are named");
    let inside = optional(&field.ty);
    let mut known = Known {
        ident,
        name: ident.to_string().trim_start_matches("r#").to_string(),
        value: inside.unwrap_or(&field.ty),
        is_optional: inside.is_some(),
        doc: documentation(&field.attrs),
        unit: String::new(),
        default: String::new(),
        shape: None,
    };
    for attribute in field.attrs.iter().filter(|attribute| attribute.path().is_ident("key")) {
        attribute.parse_nested_meta(|meta| {
            let text = |value: syn::parse::ParseStream<'_>| value.parse::<LitStr>().map(|text| text.value());
            match () {
                () if meta.path.is_ident("unit") => known.unit = text(meta.value()?)?,
                () if meta.path.is_ident("default") => known.default = text(meta.value()?)?,
                () if meta.path.is_ident("name") => known.name = text(meta.value()?)?,
                () if meta.path.is_ident("shape") => known.shape = Some(meta.value()?.parse()?),
                () => return Err(meta.error("a key has `unit`, `default`, `name` and `shape`")),
            }
            Ok(())
        })?;
    }
    if known.doc.is_empty() {
        return Err(Error::new_spanned(field, "the documentation of a key is that of its field, and there is none"));
    }
    if known.is_optional == known.default.is_empty() {
        return Err(Error::new_spanned(field, "a key that may be left out, and no other, has a `default` for people"));
    }
    Ok(known)
}

/// What is inside of an `Option`.
fn optional(ty: &Type) -> Option<&Type> {
    let Type::Path(path) = ty else { return None };
    let last = path.path.segments.last().filter(|last| last.ident == "Option")?;
    let syn::PathArguments::AngleBracketed(arguments) = &last.arguments else { return None };
    match arguments.args.first()? {
        syn::GenericArgument::Type(inside) => Some(inside),
        _ => None,
    }
}

/// The lines of documentation as one.
fn documentation(attributes: &[Attribute]) -> String {
    let lines = attributes.iter().filter_map(|attribute| match &attribute.meta {
        syn::Meta::NameValue(pair) if pair.path.is_ident("doc") => match &pair.value {
            Expr::Lit(syn::ExprLit { lit: syn::Lit::Str(text), .. }) => Some(text.value().trim().to_string()),
            _ => None,
        },
        _ => None,
    });
    lines.collect::<Vec<_>>().join(" ")
}
